#pragma once

#include <Eigen/Core>

#include <algorithm>

namespace tarsus {

/// The point of the segment from a to b nearest to p.
struct NearestOnSegment {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double distance = 0.0;
};

[[nodiscard]] inline NearestOnSegment nearestOnSegment(const Eigen::Vector3d& p,
                                                       const Eigen::Vector3d& a,
                                                       const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  const Eigen::Vector3d position = a + t * along;
  return {position, (p - position).norm()};
}

}  // namespace tarsus
