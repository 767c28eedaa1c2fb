#pragma once

#include "measurement/outline/outline_editor.h"

namespace tarsus {

/// How a place on the screen becomes a click on the surface.
struct ClickOptions {
  double max_snap_distance_mm = 5.0;  ///< a place farther from the surface is "off the model"
  bool magnetic = false;              ///< move to a clear edge of colour or crease nearby
};

// Each edit gives the next outline; where it could not be made, the same one with its problem.
// Places are in the scan frame [mm]; clicks are numbered from 0.

/// @errors in problem(): OutlineOffSurface
[[nodiscard]] OutlineEditor appendClick(const OutlineEditor& editor,
                                        const Eigen::Vector3d& place_mm,
                                        const ClickOptions& options = {});
/// Into the piece of line nearest to the place. @errors as above
[[nodiscard]] OutlineEditor insertClick(const OutlineEditor& editor,
                                        const Eigen::Vector3d& place_mm,
                                        const ClickOptions& options = {});
/// @errors as above
[[nodiscard]] OutlineEditor moveClick(const OutlineEditor& editor,
                                      int click,
                                      const Eigen::Vector3d& place_mm,
                                      const ClickOptions& options = {});
[[nodiscard]] OutlineEditor deleteClick(const OutlineEditor& editor, int click);
/// @errors in problem(): OutlineInvalid under 3 clicks
[[nodiscard]] OutlineEditor closeOutline(const OutlineEditor& editor);
[[nodiscard]] OutlineEditor makeSmooth(const OutlineEditor& editor, bool smooth);
/// An outline from a file or record: its points become clicks, those on the straight line between
/// their neighbours apart. The curve is that of traceOutline.
[[nodiscard]] OutlineEditor loadOutline(const OutlineEditor& editor,
                                        std::span<const Eigen::Vector3d> points_mm,
                                        const ClickOptions& options = {});

/// The place as a point of the surface, moved to an edge where that is asked for.
/// @errors OutlineOffSurface, OutlineInvalid (not a number)
[[nodiscard]] tl::expected<SurfacePoint, OutlineProblem> bindClick(const OutlineEditor& editor,
                                                                   const Eigen::Vector3d& place_mm,
                                                                   const ClickOptions& options);

/// Where a line is nearest to a place: on which piece, how far along the whole line.
struct PlaceOnLine {
  int piece = -1;
  double along_mm = 0.0;
  double distance_mm = 0.0;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
};
/// Nothing where there is no line yet.
[[nodiscard]] std::optional<PlaceOnLine> nearestOnLine(const OutlineEditor& editor,
                                                       const Eigen::Vector3d& place_mm);

}  // namespace tarsus
