#pragma once

#include "measurement/comparison/registration.h"
#include "tests/measurement/outline/wound_surface.h"

#include <optional>

namespace tarsus::test {

/// Skin that lies like that of a foot: curved both ways and bumpy over centimetres. Other seeds
/// are other feet.
[[nodiscard]] Skin unevenSkin(std::uint64_t seed);

/// A visit to a wound of known place on known skin.
struct Visit {
  TexturedMesh foot;
  WoundOutline outline;
  std::optional<Landmarks> landmarks;

  [[nodiscard]] VisitSurface surface() const {
    return {.foot = foot, .outline = outline, .landmarks = landmarks, .left_out = {}};
  }
};

struct VisitMaking {
  double radius_mm = 12.0;  ///< of the round wound in the middle
  double depth_mm = 3.0;    ///< of its flat bottom
  double half_size_mm = 75.0;
  double noise_mm = 0.1;
  std::uint64_t seed = 1;  ///< of the mesh and its noise
};
[[nodiscard]] Visit visitTo(const Skin& skin, const VisitMaking& how);

/// The same in another pose; landmarks too.
[[nodiscard]] Visit moved(Visit visit, const RigidTransform& motion);
[[nodiscard]] RigidTransform motionBy(double degrees,
                                      const Eigen::Vector3d& axis,
                                      const Eigen::Vector3d& shift_mm);

/// Farthest that a point of a's outline lies from where it belongs.
[[nodiscard]] double edgeError(const Visit& a,
                               const RigidTransform& b_from_a,
                               const RigidTransform& truth);

}  // namespace tarsus::test
