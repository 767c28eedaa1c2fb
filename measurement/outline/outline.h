#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"
#include "reconstruction/scene/mesh_index.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// Closed curve on one textured mesh, counter-clockwise seen from outside; the wound lies left.
struct WoundOutline {
  std::string mesh_sha256;           ///< the only mesh this outline is valid on
  std::vector<SurfacePoint> clicks;  ///< what the clinician placed
  std::vector<SurfacePoint> curve;   ///< joined by shortest paths, straight inside each triangle
};

struct OutlineOptions {
  double max_snap_distance_mm = 5.0;  ///< a point farther from the surface is "off the mesh"
};

/// Snaps the points to the surface and joins them by shortest paths on it; orientation is set so
/// that the smaller side lies inside.
/// @param points_mm  at least 3, scan frame; the last joins the first
/// @errors OutlineInvalid, OutlineOffSurface, OutlineSelfIntersects, SurfaceIncomplete (over a
/// hole)
[[nodiscard]] Expected<WoundOutline> traceOutline(const TexturedMesh& foot,
                                                  const MeshIndex& index,
                                                  std::span<const Eigen::Vector3d> points_mm,
                                                  const OutlineOptions& options = {});

/// Who placed a curve's points; kept in its file, so that a proposal stays known as one.
enum class OutlineSource { Drawn, Suggested, SuggestedEdited };
/// As it stands in files: drawn, suggested, suggested_edited.
[[nodiscard]] std::string_view nameOf(OutlineSource source);

/// What an outline or skin curve file holds (design.md section 4).
struct OutlineFile {
  std::vector<Eigen::Vector3d> points_mm;  ///< scan frame
  std::optional<OutlineSource> source;     ///< empty where the file does not say, or in other words
  /// The curve as it was traced, to the bit; not checked yet. Empty where the file does not hold
  /// it.
  std::optional<WoundOutline> traced;
};
/// @errors FileMissing, FileUnreadable, OutlineInvalid
[[nodiscard]] Expected<OutlineFile> readOutlineFile(const std::filesystem::path& path);
/// The outline of a file on this model: as it was traced where that was on this very model and its
/// points were not changed since, else through its points.
/// @errors those of traceOutline
[[nodiscard]] Expected<WoundOutline> outlineOn(const TexturedMesh& foot,
                                               const MeshIndex& index,
                                               const OutlineFile& file);
/// Scan frame [mm].
[[nodiscard]] std::vector<Eigen::Vector3d> positionsOf(const TriangleMesh& mesh,
                                                       std::span<const SurfacePoint> points);
/// Whether this is a point of a face of the mesh.
[[nodiscard]] bool liesOn(const TriangleMesh& mesh, const SurfacePoint& point);
/// The points alone.
[[nodiscard]] Expected<std::vector<Eigen::Vector3d>> readOutlinePoints(
    const std::filesystem::path& path);
/// How a reader that knows only the points gets about the same curve: by the clicks of one whose
/// clicks are joined straight, by all points of a smooth one.
enum class OutlineShape { Straight, Smooth };
/// With what was traced, so that the same model gives the same numbers to the bit.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeOutline(const std::filesystem::path& path,
                                          const TexturedMesh& foot,
                                          const WoundOutline& outline,
                                          OutlineShape shape,
                                          std::optional<OutlineSource> source = {});
/// Without what was traced.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeOutlinePoints(const std::filesystem::path& path,
                                                std::span<const Eigen::Vector3d> points_mm,
                                                std::optional<OutlineSource> source = {});

}  // namespace tarsus
