#include "measurement/phantom/phantom_mesh.h"

#include "measurement/outline/face_split.h"
#include "reconstruction/base/require.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kWoundStep_mm = 0.5;
constexpr double kStep_mm = 1.2;
constexpr double kBaseStep_mm = 4.0;

bool inside(const std::vector<Vector2d>& polygon, const Vector2d& p) {
  bool in = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    const bool straddles = (a.y() > p.y()) != (b.y() > p.y());
    if (straddles && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      in = !in;
    }
  }
  return in;
}

double distanceTo(const std::vector<Vector2d>& polygon, const Vector2d& p) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d ab = polygon[(i + 1) % polygon.size()] - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - t * ab).norm());
  }
  return least;
}

/// Corners of equal triangles inside the plan, none nearer to its border than 0.6 steps.
std::vector<Vector2d> gridIn(const std::vector<Vector2d>& plan, double step_mm) {
  Vector2d low = plan.front();
  Vector2d high = low;
  for (const Vector2d& p : plan) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  std::vector<Vector2d> points;
  const double row_mm = step_mm * std::sqrt(0.75);
  for (int j = 1; low.y() + row_mm * j < high.y(); ++j) {
    for (int i = 0; low.x() + step_mm * i < high.x(); ++i) {
      const Vector2d p(low.x() + step_mm * (i + (j % 2 == 0 ? 0.25 : 0.75)), low.y() + row_mm * j);
      if (inside(plan, p) && distanceTo(plan, p) > 0.6 * step_mm) {
        points.push_back(p);
      }
    }
  }
  return points;
}

/// Radii of the rings of points around a wound: both rims are among them.
struct Ring {
  double radius_mm;
  double step_mm;
  bool is_rim;
};
std::vector<Ring> ringsOf(const Crater& crater) {
  std::vector<Ring> rings;
  const auto evenly = [&](double from, double to) {
    const int steps = static_cast<int>(std::ceil((to - from) / kWoundStep_mm));
    for (int k = 1; k <= steps; ++k) {
      rings.push_back({from + (to - from) * k / steps, kWoundStep_mm, k == steps});
    }
  };
  evenly(0.0, crater.floor_radius_mm);
  evenly(crater.floor_radius_mm, crater.radius_mm);
  const double end_mm = crater.radius_mm + kExactSkin_mm;
  for (double step = kWoundStep_mm, r = crater.radius_mm + step; r < end_mm + 1e-9; r += step) {
    rings.push_back({r, step, false});
    step = std::min(kStep_mm, 1.15 * step);
  }
  return rings;
}

class Surface {
 public:
  explicit Surface(const PhantomDesign& design) : design_(design) {
    for (const Vector2d& p : design.plan) {
      top_.border.push_back(add(p, design.healthy_top_mm(p)));
    }
    std::vector<std::vector<Vector2d>> taken;
    for (const PhantomWound& wound : design.wounds) {
      taken.push_back(addWound(wound));
    }
    for (const Vector2d& p : gridIn(design.plan, kStep_mm)) {
      const auto holds = [&](const std::vector<Vector2d>& zone) { return inside(zone, p); };
      if (std::none_of(taken.begin(), taken.end(), holds)) {
        add(p, design.healthy_top_mm(p));
      }
    }
  }

  [[nodiscard]] TriangleMesh closed() {
    TriangleMesh mesh;
    addFaces(top_, 0, false, mesh);
    FaceToSplit base;
    base.points = design_.plan;
    const int count = static_cast<int>(design_.plan.size());
    for (int i = 0; i < count; ++i) {
      base.border.push_back(i);
    }
    for (const Vector2d& p : gridIn(design_.plan, kBaseStep_mm)) {
      base.points.push_back(p);
    }
    const int first = static_cast<int>(points_.size());
    for (const Vector2d& p : base.points) {
      points_.emplace_back(p.x(), p.y(), 0.0);
    }
    addFaces(base, first, true, mesh);
    for (int i = 0; i < count; ++i) {
      const int j = (i + 1) % count;
      mesh.faces.emplace_back(first + i, first + j, top_.border[j]);
      mesh.faces.emplace_back(first + i, top_.border[j], top_.border[i]);
    }
    for (const Vector3d& p : points_) {
      mesh.vertices.push_back(p.cast<float>());
    }
    return mesh;
  }

 private:
  int add(const Vector2d& plan, double z) {
    top_.points.push_back(plan);
    points_.emplace_back(plan.x(), plan.y(), z);
    return static_cast<int>(points_.size()) - 1;
  }

  /// @return  the part of the plan that is the wound's, with its exact skin
  std::vector<Vector2d> addWound(const PhantomWound& wound) {
    const auto place = [&](double r, double angle) -> Vector3d {
      return wound.phantom_from_wound * bedPoint(wound.crater, r, angle);
    };
    const Vector3d middle = place(0.0, 0.0);
    add(middle.head<2>(), middle.z());
    const std::vector<Ring> rings = ringsOf(wound.crater);
    for (std::size_t k = 0; k < rings.size(); ++k) {
      const int count =
          std::max(6, static_cast<int>(std::round(kTurn * rings[k].radius_mm / rings[k].step_mm)));
      std::vector<int> ring;
      for (int i = 0; i < count; ++i) {
        const double turned = k % 2 == 0 ? 0.0 : 0.5;
        const Vector3d p = place(rings[k].radius_mm, kTurn * (i + turned) / count);
        ring.push_back(add(p.head<2>(), p.z()));
      }
      for (int i = 0; rings[k].is_rim && i < count; ++i) {
        top_.segments.emplace_back(ring[i], ring[(i + 1) % count]);
      }
    }
    std::vector<Vector2d> zone;
    constexpr int kZonePoints = 120;
    for (int i = 0; i < kZonePoints; ++i) {
      const double end_mm = wound.crater.radius_mm + kExactSkin_mm + 0.5 * kStep_mm;
      zone.emplace_back(place(end_mm, kTurn * i / kZonePoints).head<2>());
    }
    return zone;
  }

  static void addFaces(const FaceToSplit& plan, int first, bool downward, TriangleMesh& mesh) {
    const auto triangles = splitFace(plan);
    TARSUS_REQUIRE(triangles.has_value(), "a phantom's plan with distinct points");
    for (const auto& t : *triangles) {
      mesh.faces.emplace_back(
          first + t[0], first + t[downward ? 2 : 1], first + t[downward ? 1 : 2]);
    }
  }

  const PhantomDesign& design_;
  std::vector<Vector3d> points_;  ///< the top's first, same order as top_.points
  FaceToSplit top_;
};

}  // namespace

TriangleMesh meshOf(const PhantomDesign& design) { return Surface(design).closed(); }

}  // namespace tarsus
