#pragma once

#include "measurement/outline/curve_distance.h"
#include "measurement/outline/cut.h"
#include "measurement/outline/surface_curve.h"
#include "measurement/outline/surface_patch.h"
#include "measurement/wound/measure.h"
#include "measurement/wound/reference_skin.h"

#include <optional>
#include <vector>

namespace tarsus {

/// The neighbourhood of one wound, cut along its outline: all that measuring needs of the mesh.
struct WoundSite {
  SurfacePatch patch;
  SurfaceCurve outline;
  CutMesh cut;
  std::vector<double> outline_distance_mm;  ///< #V of the patch, negative inside
  std::vector<double> skin_distance_mm;     ///< #V from the skin curve, negative inside
  std::vector<Eigen::Vector3d> skin_curve_mm;
  bool skin_curve_closed = true;  ///< false: it runs off the model
};

/// @errors OutlineInvalid, SkinCurveInvalid, SurfaceIncomplete
[[nodiscard]] Expected<WoundSite> openSite(const TexturedMesh& foot,
                                           const WoundOutline& outline,
                                           const std::optional<WoundOutline>& skin_curve,
                                           const MeasureOptions& options);

/// Vertices between the skin curve, moved outward by `shift_mm`, and the annulus' outer end.
[[nodiscard]] std::vector<SkinSample> skinSamples(const TexturedMesh& foot,
                                                  const WoundSite& site,
                                                  double shift_mm,
                                                  const MeasureOptions& options);

/// The site with its outline moved outward by `shift_mm`; nothing where that runs off the model.
[[nodiscard]] std::optional<CutMesh> movedOutline(const WoundSite& site, double shift_mm);

/// Whether a hole or the model's edge lies within `reach_mm` outside the outline.
[[nodiscard]] bool nearModelEdge(const WoundSite& site, double reach_mm);

}  // namespace tarsus
