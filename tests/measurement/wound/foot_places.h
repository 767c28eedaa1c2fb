#pragma once

#include "measurement/wound/reference_skin.h"
#include "reconstruction/scene/mesh.h"
#include "tests/measurement/outline/wound_surface.h"

#include <optional>
#include <vector>

namespace tarsus::test {

/// Where a round wound would be on a healthy foot.
struct FootPlace {
  std::vector<SkinSample> around;       ///< outside the skin curve, to kSamples_mm
  std::vector<Eigen::Vector3d> inside;  ///< the true skin inside the outline
  std::vector<Eigen::Vector3d> inside_normals;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};

/// Nothing between toes, over a sharp edge, or higher than 80 mm above the sole (z = 0).
[[nodiscard]] std::optional<FootPlace> placeAt(const TriangleMesh& foot,
                                               int vertex,
                                               double radius_mm,
                                               double skin_curve_mm);

[[nodiscard]] int nearestVertex(const TriangleMesh& foot, const Eigen::Vector3d& p);

/// Moves the skin around along its normals; correlated over 1.5 mm.
void addNoise(FootPlace& place, double noise_mm, std::uint64_t seed);

}  // namespace tarsus::test
