#include "measurement/outline/smooth_line.h"

#include "measurement/outline/simplify.h"
#include "reconstruction/scene/nearest_on_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace tarsus {
namespace {

/// Chords of the curve leave it by no more than this.
constexpr double kChord_mm = 0.02;
/// Beyond the bulge of the curve, the surface is looked for this far around.
constexpr double kMargin_mm = 1.5;
/// The surface's direction is the mean over about this distance: relief finer than this would
/// shake the line.
constexpr double kNormalReach_mm = 1.0;

using Points = std::vector<Eigen::Vector3d>;

double distanceTo(const Points& points, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& q : points) {
    least = std::min(least, (p - q).norm());
  }
  return least;
}

Eigen::Vector3d cornerMean(const SurfacePatch& patch, int face) {
  const auto& f = patch.faces[face];
  return (patch.vertices[f[0]] + patch.vertices[f[1]] + patch.vertices[f[2]]) / 3.0;
}

/// Faces connected with the way that lie within reach of it.
std::vector<int> facesAround(const SurfacePatch& patch,
                             const std::vector<SurfaceNode>& way,
                             double reach_mm) {
  Points places;
  std::vector<int> open;
  std::unordered_set<int> seen;
  for (const SurfaceNode& node : way) {
    places.push_back(positionOf(patch, node));
    for (const int face : facesOf(patch, node)) {
      if (seen.insert(face).second) {
        open.push_back(face);
      }
    }
  }
  std::vector<int> faces;
  while (!open.empty()) {
    const int face = open.back();
    open.pop_back();
    faces.push_back(face);
    for (const int next : patch.neighbors[face]) {
      if (next >= 0 && distanceTo(places, cornerMean(patch, next)) < reach_mm &&
          seen.insert(next).second) {
        open.push_back(next);
      }
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

Triangle triangleOf(const SurfacePatch& patch, int face) {
  const auto& f = patch.faces[face];
  return {patch.vertices[f[0]], patch.vertices[f[1]], patch.vertices[f[2]]};
}

Eigen::Vector3d normalNear(const SurfacePatch& patch,
                           const std::vector<int>& faces,
                           const Eigen::Vector3d& p) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int face : faces) {
    const Triangle t = triangleOf(patch, face);
    const double d = (cornerMean(patch, face) - p).norm() / kNormalReach_mm;
    sum += std::exp(-0.5 * d * d) * (t.b - t.a).cross(t.c - t.a);
  }
  return sum.normalized();
}

/// Where the line through p along `normal` meets the triangle.
std::optional<Eigen::Vector3d> meetLine(const Triangle& t,
                                        const Eigen::Vector3d& p,
                                        const Eigen::Vector3d& normal) {
  const Eigen::Vector3d ab = t.b - t.a;
  const Eigen::Vector3d ac = t.c - t.a;
  const double determinant = ab.cross(ac).dot(normal);
  const Eigen::Vector3d turned = (p - t.a).cross(normal);
  const double v = -ac.dot(turned) / determinant;
  const double w = ab.dot(turned) / determinant;
  if (!(v >= 0.0 && w >= 0.0 && v + w <= 1.0)) {
    return std::nullopt;  // also where the triangle stands on edge
  }
  return Eigen::Vector3d(1.0 - v - w, v, w);
}

/// Point of the faces above or below p; the nearest one where there is none.
SurfacePoint putOn(const SurfacePatch& patch,
                   const std::vector<int>& faces,
                   const Eigen::Vector3d& p) {
  const Eigen::Vector3d normal = normalNear(patch, faces, p);
  SurfacePoint best;
  SurfacePoint nearest;
  double best_mm = std::numeric_limits<double>::infinity();
  double nearest_mm = best_mm;
  for (const int face : faces) {
    const Triangle t = triangleOf(patch, face);
    const auto offer = [&](const Eigen::Vector3d& barycentric, double& least, SurfacePoint& out) {
      const double d = (t.at(barycentric) - p).norm();
      if (d < least) {
        least = d;
        out = {.face = static_cast<std::uint32_t>(patch.mesh_face[face]),
               .barycentric = barycentric};
      }
    };
    if (const auto hit = meetLine(t, p, normal)) {
      offer(*hit, best_mm, best);
    }
    offer(nearestOnTriangle(t, p), nearest_mm, nearest);
  }
  return std::isfinite(best_mm) && best_mm < nearest_mm + kMargin_mm ? best : nearest;
}

}  // namespace

std::vector<Eigen::Vector3d> splinePoints(std::array<Eigen::Vector3d, 4> p) {
  const double length_mm = (p[2] - p[1]).norm();
  if ((p[1] - p[0]).norm() < 1e-6) {
    p[0] = 2.0 * p[1] - p[2];
  }
  if ((p[3] - p[2]).norm() < 1e-6) {
    p[3] = 2.0 * p[2] - p[1];
  }
  std::array<double, 4> t{};
  for (int i = 0; i < 3; ++i) {
    t[i + 1] = t[i] + std::sqrt((p[i + 1] - p[i]).norm());
  }
  const int count = std::clamp(static_cast<int>(std::ceil(length_mm / 0.2)), 8, 100);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= count; ++i) {
    const double u = t[1] + (t[2] - t[1]) * i / count;
    std::array<Eigen::Vector3d, 4> q = p;
    for (int level = 1; level <= 3; ++level) {
      for (int k = 0; k + level <= 3; ++k) {
        const int first = level == 3 ? 1 : k;
        const int last = level == 3 ? 2 : k + level;
        const double w = (u - t[first]) / (t[last] - t[first]);
        q[k] = (1.0 - w) * q[k] + w * q[k + 1];
      }
    }
    points.push_back(q[0]);
  }
  return points;
}

OutlinePiece traceSmoothPiece(GrowingPatch& local, const std::array<SurfacePoint, 4>& clicks) {
  std::array<Eigen::Vector3d, 4> corners;
  for (int i = 0; i < 4; ++i) {
    corners[i] = positionOf(local.mesh(), clicks[i]);
  }
  OutlinePiece straight = tracePiece(local, clicks[1], clicks[2]);
  if (straight.problem || (corners[2] - corners[1]).norm() < kChord_mm) {
    return straight;
  }
  const Points curve = splinePoints(corners);
  const SurfacePatch& patch = local.patch();
  const auto way = nodesOf(patch, straight.way);
  Points places{corners[2]};
  for (const SurfaceNode& node : way) {
    places.push_back(positionOf(patch, node));
  }
  double bulge_mm = 0.0;
  for (const auto& p : curve) {
    bulge_mm = std::max(bulge_mm, distanceTo(places, p));
  }
  const auto faces = facesAround(patch, way, bulge_mm + kMargin_mm);
  std::vector<SurfacePoint> stops{clicks[1]};
  for (const int i : essentialPointsOfOpen(curve, kChord_mm)) {
    if (i > 0 && i + 1 < static_cast<int>(curve.size())) {
      stops.push_back(putOn(patch, faces, curve[i]));
    }
  }
  stops.push_back(clicks[2]);
  OutlinePiece smooth;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const OutlinePiece step = tracePiece(local, stops[i], stops[i + 1]);
    smooth.way.insert(smooth.way.end(), step.way.begin(), step.way.end());
    if (step.problem) {
      smooth.problem = step.problem;
    }
  }
  return smooth;
}

}  // namespace tarsus
