#include "reconstruction/scene/nearest_on_triangle.h"

#include <algorithm>
#include <array>
#include <limits>

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

/// The nearest point of those edges that `wanted` names: ab, bc, ca.
Eigen::Vector3d nearestOnEdges(const Triangle& t,
                               const Eigen::Vector3d& p,
                               const std::array<bool, 3>& wanted) {
  const std::array<const Eigen::Vector3d*, 3> corners{&t.a, &t.b, &t.c};
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  double best_squared = std::numeric_limits<double>::infinity();
  for (std::size_t from = 0; from < 3; ++from) {
    const std::size_t to = (from + 1) % 3;
    if (!wanted[from]) {
      continue;
    }
    const double s = nearestOnSegment(*corners[from], *corners[to], p);
    const Eigen::Vector3d point = *corners[from] + s * (*corners[to] - *corners[from]);
    const double squared = (point - p).squaredNorm();
    if (squared < best_squared) {
      best_squared = squared;
      best.setZero();
      best[static_cast<int>(from)] = 1.0 - s;
      best[static_cast<int>(to)] = s;
    }
  }
  return best;
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
  if (!(area_squared > 0.0)) {
    return nearestOnEdges(t, p, {true, true, true});
  }
  if (u >= 0.0 && v >= 0.0 && w >= 0.0) {
    return Eigen::Vector3d(u, v, w) / area_squared;
  }
  // The nearest point lies on an edge that has p on its outer side, or at an end of one.
  return nearestOnEdges(t, p, {w < 0.0, u < 0.0, v < 0.0});
}

}  // namespace tarsus
