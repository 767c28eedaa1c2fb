#include "measurement/outline/face_strip.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Third corner of a triangle, right of the edge a -> b, from its distances to a and b.
Eigen::Vector2d placeApex(const Eigen::Vector2d& a,
                          const Eigen::Vector2d& b,
                          double from_a,
                          double from_b) {
  const Eigen::Vector2d along = b - a;
  const double length = along.norm();
  const Eigen::Vector2d unit = along / length;
  const double x = (from_a * from_a - from_b * from_b + length * length) / (2.0 * length);
  const double y = std::sqrt(std::max(0.0, from_a * from_a - x * x));
  return a + x * unit + y * Eigen::Vector2d(unit.y(), -unit.x());
}

using Corners2 = std::array<Eigen::Vector2d, 3>;

Corners2 layFirst(const SurfacePatch& patch, int face) {
  const auto& f = patch.faces[face];
  const Eigen::Vector3d ab = patch.vertices[f[1]] - patch.vertices[f[0]];
  const Eigen::Vector3d ac = patch.vertices[f[2]] - patch.vertices[f[0]];
  const double length = ab.norm();
  const double x = ac.dot(ab) / length;
  return {Eigen::Vector2d::Zero(),
          Eigen::Vector2d(length, 0.0),
          Eigen::Vector2d(x, ab.cross(ac).norm() / length)};
}

Eigen::Vector2d mix(const Corners2& corners, const Eigen::Vector3d& barycentric) {
  return barycentric[0] * corners[0] + barycentric[1] * corners[1] + barycentric[2] * corners[2];
}

int sharedCorner(const SurfacePatch& patch, int face, int next) {
  const auto& around = patch.neighbors[face];
  for (int k = 0; k < 3; ++k) {
    if (around[k] == next) {
      return k;
    }
  }
  TARSUS_REQUIRE(false, "faces of a strip must be neighbours");
  return -1;
}

}  // namespace

FlatStrip unfold(const SurfacePatch& patch,
                 const std::vector<int>& faces,
                 const SurfaceNode& from,
                 const SurfaceNode& to) {
  FlatStrip strip;
  strip.faces = faces;
  Corners2 corners = layFirst(patch, faces.front());
  strip.from = mix(corners, barycentricIn(patch, faces.front(), from));
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    const int k = sharedCorner(patch, faces[i], faces[i + 1]);
    const int right = patch.faces[faces[i]][k];
    const int left = patch.faces[faces[i]][(k + 1) % 3];
    strip.portals.push_back({.left_vertex = left,
                             .right_vertex = right,
                             .left = corners[(k + 1) % 3],
                             .right = corners[k]});
    const auto& next = patch.faces[faces[i + 1]];
    Corners2 next_corners;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d& p = patch.vertices[next[c]];
      next_corners[c] = next[c] == right  ? corners[k]
                        : next[c] == left ? corners[(k + 1) % 3]
                                          : placeApex(corners[k],
                                                      corners[(k + 1) % 3],
                                                      (p - patch.vertices[right]).norm(),
                                                      (p - patch.vertices[left]).norm());
    }
    corners = next_corners;
  }
  strip.to = mix(corners, barycentricIn(patch, faces.back(), to));
  return strip;
}

namespace {

/// The cone seen from the apex, closed in by one point on either hand.
class Funnel {
 public:
  explicit Funnel(const FlatStrip& strip) : strip_(strip) { restart(strip.from, -1); }

  std::vector<StripCorner> run() {
    const int count = static_cast<int>(strip_.portals.size());
    for (int i = 0; i <= count; ++i) {
      const int turned = i < count ? narrow(i) : finish();
      i = turned >= 0 ? turned : i;
    }
    return corners_;
  }

 private:
  struct Wall {
    Eigen::Vector2d position;
    int portal = -1;
  };

  [[nodiscard]] bool open(const Wall& wall) const { return wall.position == apex_; }
  /// Positive where p lies left of the ray from the apex through the wall's point.
  [[nodiscard]] double leftOf(const Wall& wall, const Eigen::Vector2d& p) const {
    return cross(wall.position - apex_, p - apex_);
  }

  void restart(const Eigen::Vector2d& apex, int portal) {
    apex_ = apex;
    left_ = {apex, portal};
    right_ = {apex, portal};
  }

  /// The way bends here; the funnel starts again. Returns the portal to go on from.
  int turn(const Wall& wall, bool left) {
    const auto& portal = strip_.portals[wall.portal];
    corners_.push_back({.portal = wall.portal,
                        .vertex = left ? portal.left_vertex : portal.right_vertex,
                        .position = wall.position});
    const Wall at = wall;
    restart(at.position, at.portal);
    return at.portal;
  }

  int narrow(int i) {
    const auto& portal = strip_.portals[i];
    if (portal.right == apex_) {
      right_ = {apex_, i};
    } else if (open(right_) || leftOf(right_, portal.right) >= 0.0) {
      if (!open(left_) && leftOf(left_, portal.right) >= 0.0) {
        return turn(left_, true);
      }
      right_ = {portal.right, i};
    }
    if (portal.left == apex_) {
      left_ = {apex_, i};
    } else if (open(left_) || leftOf(left_, portal.left) <= 0.0) {
      if (!open(right_) && leftOf(right_, portal.left) <= 0.0) {
        return turn(right_, false);
      }
      left_ = {portal.left, i};
    }
    return -1;
  }

  int finish() {
    if (!open(left_) && leftOf(left_, strip_.to) > 0.0) {
      return turn(left_, true);
    }
    if (!open(right_) && leftOf(right_, strip_.to) < 0.0) {
      return turn(right_, false);
    }
    return -1;
  }

  const FlatStrip& strip_;
  Eigen::Vector2d apex_;
  Wall left_;
  Wall right_;
  std::vector<StripCorner> corners_;
};

}  // namespace

std::vector<StripCorner> tighten(const FlatStrip& strip) { return Funnel(strip).run(); }

}  // namespace tarsus
