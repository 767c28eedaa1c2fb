#pragma once

#include "measurement/comparison/registration.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

namespace tarsus {

struct ChangeMapOptions {
  double margin_mm = 20.0;        ///< around both outlines; ours
  double reach_mm = 20.0;         ///< more change than this is not looked for; ours
  double normal_radius_mm = 5.0;  ///< over which the normals are averaged; ours
  double default_sigma_mm = 0.2;  ///< for a model that does not carry its own
};

/// What changed at each place of b's surface in and around both wounds; b's scan frame [mm].
struct ChangeMap {
  TriangleMesh surface;                ///< of b, with its smoothed outward normals
  std::vector<float> distance_mm;      ///< #V from a to b along the normal, > 0: b stands further
                                       ///< out (filled); not a number where unseen
  std::vector<float> limit_mm;         ///< #V limit of detection
  std::vector<std::uint8_t> unseen;    ///< #V 1: one visit shows nothing here
  std::vector<std::uint8_t> in_wound;  ///< #V 1: inside one of the outlines, or both
  std::vector<Eigen::Vector3d> outline_a_mm;  ///< carried into b
  std::vector<Eigen::Vector3d> outline_b_mm;
  /// Median limit of detection inside the outlines, or everywhere where they hold no seen vertex.
  double limit_of_detection_mm = std::numeric_limits<double>::quiet_NaN();
};

/// Signed distances along b's smoothed normals. Limit of detection 1.96 sqrt(sigma_a^2 + sigma_b^2
/// + sigma_registration^2) (clinical.md section 3), where each sigma is that along the normal of
/// the surface itself, taken along the smoothed normal: steep walls are uncertain. Source: Lague,
/// Brodu and Leroux, ISPRS J. 82, 2013 (distances along smoothed normals, with limit of detection).
/// @errors OutlineInvalid, SurfaceIncomplete
[[nodiscard]] Expected<ChangeMap> mapChange(const VisitSurface& a,
                                            const VisitSurface& b,
                                            const Registration& registration,
                                            const ChangeMapOptions& options = {});

/// Colour of a change: grey within the limit of detection, three blues outwards, three oranges
/// inwards, parted at 1 and 2 mm; a darker grey where nothing was seen.
[[nodiscard]] Rgb8 changeColor(float distance_mm, float limit_mm, bool unseen);

/// The map as coloured mesh with the properties `change_mm` (also as `quality`, which MeshLab
/// shows), `limit_of_detection_mm` and `unseen`.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeChangeMap(const std::filesystem::path& path,
                                            const ChangeMap& map);

}  // namespace tarsus
