#pragma once

#include <Eigen/Geometry>

namespace tarsus {

/// Corners of one triangle, any unit.
struct Triangle {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  Eigen::Vector3d c;

  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& barycentric) const {
    return barycentric[0] * a + barycentric[1] * b + barycentric[2] * c;
  }
};

/// Barycentric coordinates (each >= 0, sum 1) of the triangle's point nearest to p; a triangle
/// that has shrunk to a line or a point is that line or point.
/// Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
[[nodiscard]] Eigen::Vector3d nearestOnTriangle(const Triangle& triangle, const Eigen::Vector3d& p);

}  // namespace tarsus
