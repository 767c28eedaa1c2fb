#pragma once

#include "reconstruction/scene/frame.h"

#include <Eigen/Core>

namespace tarsus {

/// A rigid motion as six numbers in mm: turn times 100 mm, then the shift of the point it is
/// taken about.
using MotionVector = Eigen::Matrix<double, 6, 1>;
using MotionMatrix = Eigen::Matrix<double, 6, 6>;

/// Turns are measured by how far they move a point this far from the centre.
constexpr double kMotionLever_mm = 100.0;

/// The motion that these six numbers mean about a centre; exact for any angle.
[[nodiscard]] inline RigidTransform motionOf(const MotionVector& vector,
                                             const Eigen::Vector3d& center) {
  const Eigen::Vector3d rotation = vector.head<3>() / kMotionLever_mm;
  const double angle = rotation.norm();
  RigidTransform motion = RigidTransform::Identity();
  if (angle > 0.0) {
    motion.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  }
  motion.translation() = center + vector.tail<3>() - motion.linear() * center;
  return motion;
}

}  // namespace tarsus
