#include "reconstruction/scene/nearest_on_triangle.h"

#include <algorithm>
#include <array>

namespace tarsus {
namespace {

/// Parameter in [0, 1] of the point of segment `from`-`to` nearest to p.
double nearestOnSegment(const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to,
                        const Eigen::Vector3d& p) {
  const Eigen::Vector3d along = to - from;
  const double length_squared = along.squaredNorm();
  return length_squared > 0.0 ? std::clamp((p - from).dot(along) / length_squared, 0.0, 1.0) : 0.0;
}

Eigen::Vector3d nearestOnEdges(const Triangle& t, const Eigen::Vector3d& p) {
  const double ab = nearestOnSegment(t.a, t.b, p);
  const double bc = nearestOnSegment(t.b, t.c, p);
  const double ca = nearestOnSegment(t.c, t.a, p);
  const std::array<Eigen::Vector3d, 3> candidates{Eigen::Vector3d(1.0 - ab, ab, 0.0),
                                                  Eigen::Vector3d(0.0, 1.0 - bc, bc),
                                                  Eigen::Vector3d(ca, 0.0, 1.0 - ca)};
  return *std::min_element(
      candidates.begin(), candidates.end(), [&](const auto& left, const auto& right) {
        return (t.at(left) - p).squaredNorm() < (t.at(right) - p).squaredNorm();
      });
}

}  // namespace

Eigen::Vector3d nearestOnTriangle(const Triangle& t, const Eigen::Vector3d& p) {
  const Eigen::Vector3d ab = t.b - t.a;
  const Eigen::Vector3d ac = t.c - t.a;
  const Eigen::Vector3d normal = ab.cross(ac);
  const double area_squared = normal.squaredNorm();
  const Eigen::Vector3d ap = p - t.a;
  const double v = ap.cross(ac).dot(normal);
  const double w = ab.cross(ap).dot(normal);
  const double u = area_squared - v - w;
  if (area_squared > 0.0 && u >= 0.0 && v >= 0.0 && w >= 0.0) {
    const Eigen::Vector3d inside = Eigen::Vector3d(u, v, w) / area_squared;
    if (inside.allFinite()) {
      return inside;
    }
  }
  return nearestOnEdges(t, p);
}

}  // namespace tarsus
