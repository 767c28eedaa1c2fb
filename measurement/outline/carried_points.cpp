#include "measurement/outline/carried_points.h"

#include "measurement/outline/surface_patch.h"
#include "reconstruction/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tarsus {
namespace {

/// Nearer than this a point lies on the surface: it was placed there, by a click or in a file's
/// digits.
constexpr double kOn_mm = 0.005;
/// Skin beside a point: beyond the rounding of its rim, and no farther than it stays the same skin.
constexpr double kFrom_mm = 1.0;
constexpr double kBetween_mm = 3.5;
constexpr double kTo_mm = 6.0;
constexpr double kLeastCosine = 0.5;  ///< of the way there to the outward direction
/// Not into the depth of a steep wall: at most this many times as far as the nearest point.
constexpr double kFarther = 4.0;

struct Side {
  Eigen::Vector3d center;
  Eigen::Vector3d twice_area;  ///< outward normal
};

std::vector<Side> facesOf(const SurfacePatch& patch) {
  std::vector<Side> sides;
  sides.reserve(patch.faces.size());
  for (const auto& f : patch.faces) {
    const Eigen::Vector3d& a = patch.vertices[f[0]];
    const Eigen::Vector3d& b = patch.vertices[f[1]];
    const Eigen::Vector3d& c = patch.vertices[f[2]];
    sides.push_back({(a + b + c) / 3.0, (b - a).cross(c - a)});
  }
  return sides;
}

/// The normal at p by that of the skin beside it, near and farther away, continued to p itself: on
/// a toe it turns by 15 degrees in between.
Eigen::Vector3d normalBeside(const std::vector<Side>& sides,
                             const Eigen::Vector3d& p,
                             const Eigen::Vector3d& outward) {
  struct Ring {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double away = 0.0;
    double weight = 0.0;
  };
  std::array<Ring, 2> rings;
  for (const Side& side : sides) {
    const Eigen::Vector3d way = side.center - p;
    const double d = way.norm();
    if (d <= kFrom_mm || d >= kTo_mm || way.dot(outward) < kLeastCosine * d) {
      continue;
    }
    Ring& ring = rings[d < kBetween_mm ? 0 : 1];
    const double weight = side.twice_area.norm();
    ring.normal += side.twice_area;
    ring.away += weight * d;
    ring.weight += weight;
  }
  if (!(rings[0].weight > 0.0) || !(rings[1].weight > 0.0)) {
    return Eigen::Vector3d::Zero();
  }
  for (Ring& ring : rings) {
    ring.normal.normalize();
    ring.away /= ring.weight;
  }
  const double ahead = rings[0].away / (rings[1].away - rings[0].away);
  return (rings[0].normal + ahead * (rings[0].normal - rings[1].normal)).normalized();
}

std::optional<MeshIndex::NearestPoint> carried(const TriangleMesh& mesh,
                                               const MeshIndex& index,
                                               const Eigen::Vector3d& p,
                                               const Eigen::Vector3d& normal) {
  std::optional<MeshIndex::NearestPoint> best;
  for (const double sense : {-1.0, 1.0}) {
    const Eigen::Vector3d direction = sense * normal;
    const auto hit = index.castRay(p.cast<float>(), direction.cast<float>());
    if (hit.face < 0 || (best && static_cast<double>(hit.distance) >= best->distance_mm)) {
      continue;
    }
    SurfacePoint point;
    point.face = static_cast<decltype(point.face)>(hit.face);
    Eigen::Vector3d b = hit.barycentric.cast<double>().cwiseMax(0.0);
    point.barycentric = b / b.sum();
    best = MeshIndex::NearestPoint{.point = point,
                                   .position_mm = positionOf(mesh, point),
                                   .distance_mm = static_cast<double>(hit.distance)};
  }
  return best;
}

}  // namespace

void carryAlongSkin(const TriangleMesh& mesh,
                    const MeshIndex& index,
                    std::span<const Eigen::Vector3d> points_mm,
                    std::span<MeshIndex::NearestPoint> nearest) {
  if (std::ranges::all_of(nearest, [](const auto& n) { return n.distance_mm < kOn_mm; })) {
    return;
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& p : points_mm) {
    middle += p / static_cast<double>(points_mm.size());
  }
  double reach_mm = 0.0;
  for (const auto& p : points_mm) {
    reach_mm = std::max(reach_mm, (p - middle).norm());
  }
  const std::vector<Side> sides = facesOf(extractPatch(mesh, middle, reach_mm + kTo_mm));
  parallelFor(static_cast<int>(points_mm.size()), [&](int i) {
    const Eigen::Vector3d& p = points_mm[static_cast<std::size_t>(i)];
    MeshIndex::NearestPoint& at = nearest[static_cast<std::size_t>(i)];
    const Eigen::Vector3d outward = p - middle;
    if (at.distance_mm < kOn_mm || outward.norm() <= 0.0) {
      return;
    }
    const Eigen::Vector3d normal = normalBeside(sides, p, outward.normalized());
    if (normal.norm() <= 0.0) {
      return;
    }
    if (const auto onto = carried(mesh, index, p, normal);
        onto && onto->distance_mm <= kFarther * at.distance_mm) {
      at = *onto;
    }
  });
}

}  // namespace tarsus
