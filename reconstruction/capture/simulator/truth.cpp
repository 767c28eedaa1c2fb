#include "reconstruction/capture/simulator/truth.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"
#include "reconstruction/capture/simulator/closed_curve.h"
#include "reconstruction/scene/mesh_index.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kSkinCurveOffsetMm = 2.0;
constexpr double kGridStepMm = 0.1;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The rim: edges with an inside face on one side only, inside to the left seen from outside.
ClosedCurve rimOf(const CarvedFoot& foot, int which) {
  std::set<std::pair<int, int>> open;
  for (std::size_t i = 0; i < foot.intact.faces.size(); ++i) {
    if (foot.ulcer_of_face[i] != which) {
      continue;
    }
    const Vector3i& f = foot.intact.faces[i];
    for (int k = 0; k < 3; ++k) {
      const std::pair<int, int> edge(f[k], f[(k + 1) % 3]);
      if (open.erase({edge.second, edge.first}) == 0) {
        open.insert(edge);
      }
    }
  }
  std::map<int, int> next(open.begin(), open.end());
  TARSUS_REQUIRE(next.size() == open.size() && !next.empty(), "the rim is one simple loop");
  ClosedCurve rim;
  int v = next.begin()->first;
  do {
    rim.push_back(foot.intact.positions[at(v)]);
    v = next[v];
  } while (v != next.begin()->first && rim.size() <= next.size());
  TARSUS_REQUIRE(rim.size() == next.size(), "the rim is one simple loop");
  return rim;
}

/// Depth that a hundredth of the area lies below; from (depth, area) of each face.
double percentile99(std::vector<Vector2d> depth_area) {
  std::ranges::sort(depth_area, std::ranges::greater(), [](const Vector2d& d) { return d.x(); });
  double left_mm2 = 0.0;
  for (const Vector2d& d : depth_area) {
    left_mm2 += 0.01 * d.y();
  }
  for (const Vector2d& d : depth_area) {
    left_mm2 -= d.y();
    if (left_mm2 <= 0.0) {
      return d.x();
    }
  }
  return 0.0;
}

/// First way: sums over the faces inside the rim. The bed and the skin share the rim, so together
/// they bound the volume, which is the difference of their cones from any one point.
void sumFaces(const CarvedFoot& foot, int which, WoundTruth& truth) {
  const Vector3d apex = foot.ulcers[at(which)].center();
  double six_volumes = 0.0;
  std::vector<Vector2d> depth_area;
  for (std::size_t i = 0; i < foot.intact.faces.size(); ++i) {
    if (foot.ulcer_of_face[i] != which) {
      continue;
    }
    const Vector3i& f = foot.intact.faces[i];
    const auto cone = [&](const std::vector<Vector3d>& points, double& area_mm2) {
      const Vector3d a = points[at(f[0])] - apex;
      const Vector3d b = points[at(f[1])] - apex;
      const Vector3d c = points[at(f[2])] - apex;
      area_mm2 += 0.5 * (b - a).cross(c - a).norm();
      return a.dot(b.cross(c));
    };
    six_volumes += cone(foot.intact.positions, truth.opening_area_mm2);
    const double bed_before_mm2 = truth.bed_area_mm2;
    six_volumes -= cone(foot.carved, truth.bed_area_mm2);
    double depth_mm = 0.0;
    for (int k = 0; k < 3; ++k) {
      truth.max_depth_mm = std::max(truth.max_depth_mm, foot.depth_mm[at(f[k])]);
      depth_mm += foot.depth_mm[at(f[k])] / 3.0;
    }
    depth_area.emplace_back(depth_mm, truth.bed_area_mm2 - bed_before_mm2);
  }
  truth.volume_mm3 = six_volumes / 6.0;
  truth.p99_depth_mm = percentile99(std::move(depth_area));
}

/// The faces around an ulcer alone, in its own coordinates: small numbers for single precision.
TriangleMesh localMesh(const CarvedFoot& foot,
                       const Ulcer& ulcer,
                       const std::vector<Vector3d>& points) {
  TriangleMesh all;
  std::vector<int> name(points.size(), -1);
  for (const Vector3i& f : foot.intact.faces) {
    const bool near = ulcer.isNear(foot.intact.positions[at(f[0])], 2.0);
    if (!near) {
      continue;
    }
    Vector3i named;
    for (int k = 0; k < 3; ++k) {
      int& n = name[at(f[k])];
      if (n < 0) {
        n = static_cast<int>(all.vertices.size());
        all.vertices.push_back(ulcer.local(points[at(f[k])]).cast<float>());
      }
      named[k] = n;
    }
    all.faces.push_back(named);
  }
  return all;
}

/// Where the line x = const runs inside the polygon: sorted y of its crossings, in pairs.
std::vector<double> crossings(const std::vector<Vector2d>& polygon, double x) {
  std::vector<double> ys;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.x() <= x) != (b.x() <= x)) {
      ys.push_back(a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y()));
    }
  }
  std::ranges::sort(ys);
  return ys;
}

/// Second way: rays along the axis over a grid inside the rim's shadow on the plane across it.
void castGrid(const CarvedFoot& foot, int which, const ClosedCurve& rim, WoundTruth& truth) {
  const Ulcer& ulcer = foot.ulcers[at(which)];
  const TriangleMesh skin = localMesh(foot, ulcer, foot.intact.positions);
  const MeshIndex skin_index(skin);
  const MeshIndex bed_index(localMesh(foot, ulcer, foot.carved));
  std::vector<Vector2d> polygon;
  for (const Vector3d& p : rim) {
    polygon.emplace_back(ulcer.local(p).head<2>());
  }
  const double reach = ulcer.reachMm() + 1.0;
  const int columns = static_cast<int>(2.0 * reach / kGridStepMm);
  std::vector<Vector2d> sums(at(columns), Vector2d::Zero());  // area, volume
  parallelFor(columns, [&](int i) {
    const double x = -reach + (i + 0.5) * kGridStepMm;
    const std::vector<double> ys = crossings(polygon, x);
    const Eigen::Vector3f down(0.0F, 0.0F, -1.0F);
    for (std::size_t k = 0; k + 1 < ys.size(); k += 2) {
      // Cells of equal width that fill the run exactly.
      const int cells = std::max(1, static_cast<int>((ys[k + 1] - ys[k]) / kGridStepMm));
      const double step = (ys[k + 1] - ys[k]) / cells;
      for (int c = 0; c < cells; ++c) {
        const Eigen::Vector3f from = Vector3d(x, ys[k] + (c + 0.5) * step, 40.0).cast<float>();
        const MeshIndex::RayHit on_skin = skin_index.castRay(from, down);
        const MeshIndex::RayHit on_bed = bed_index.castRay(from, down);
        if (on_skin.face < 0 || on_bed.face < 0) {
          continue;
        }
        const double cell_mm2 = kGridStepMm * step;
        sums[at(i)].x() += cell_mm2 / std::abs(faceNormal(skin, on_skin.face).z());
        sums[at(i)].y() += cell_mm2 * (double{on_bed.distance} - double{on_skin.distance});
      }
    }
  });
  for (const Vector2d& s : sums) {
    truth.opening_area_second_way_mm2 += s.x();
    truth.volume_second_way_mm3 += s.y();
  }
}

/// The line at a fixed distance outside the rim on the intact skin. Over 2 mm the straight
/// distance is the surface distance to better than 0.01 mm for any curvature of a foot.
ClosedCurve skinCurve(const CarvedFoot& foot, int which, const ClosedCurve& rim) {
  const Ulcer& ulcer = foot.ulcers[at(which)];
  const ClosedCurve coarse = resampled(rim, 0.3);
  const auto& points = foot.intact.positions;
  std::vector<double> beyond(points.size(), -1.0);
  parallelFor(static_cast<int>(points.size()), [&](int v) {
    const Vector3d& p = points[at(v)];
    if (ulcer.isNear(p, 5.0) && ulcer.rimDistance(p) > 0.0) {
      beyond[at(v)] = distanceTo(coarse, p) - kSkinCurveOffsetMm;
    }
  });
  std::map<std::pair<int, int>, int> name_of_edge;
  std::vector<Vector3d> crossing;
  std::vector<Vector2i> pieces;
  for (const Vector3i& f : foot.intact.faces) {
    Vector2i piece(-1, -1);
    for (int k = 0; k < 3; ++k) {
      const int a = std::min(f[k], f[(k + 1) % 3]);
      const int b = std::max(f[k], f[(k + 1) % 3]);
      if ((beyond[at(a)] > 0.0) == (beyond[at(b)] > 0.0) || !ulcer.isNear(points[at(a)], 4.0)) {
        continue;
      }
      const auto [it, is_new] = name_of_edge.try_emplace({a, b}, static_cast<int>(crossing.size()));
      if (is_new) {
        const double t = beyond[at(a)] / (beyond[at(a)] - beyond[at(b)]);
        crossing.push_back(points[at(a)] + t * (points[at(b)] - points[at(a)]));
      }
      piece[piece.x() < 0 ? 0 : 1] = it->second;
    }
    if (piece.y() >= 0) {
      pieces.push_back(piece);
    }
  }
  ClosedCurve longest;
  for (const std::vector<int>& loop : joinLoops(pieces)) {
    ClosedCurve curve;
    for (const int i : loop) {
      curve.push_back(crossing[at(i)]);
    }
    longest = lengthOf(curve) > lengthOf(longest) ? curve : longest;
  }
  return longest;
}

/// Counter-clockwise seen from outside.
void orient(ClosedCurve& curve, const Ulcer& ulcer) {
  double twice_area = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vector3d a = ulcer.local(curve[i]);
    const Vector3d b = ulcer.local(curve[(i + 1) % curve.size()]);
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  if (twice_area < 0.0) {
    std::ranges::reverse(curve);
  }
}

}  // namespace

WoundTruth measureTruth(const IntactFoot& foot, const CarvedFoot& carved, int which) {
  const Ulcer& ulcer = carved.ulcers[at(which)];
  WoundTruth truth;
  truth.site = ulcer.design().site;
  truth.center_mm = ulcer.center();
  sumFaces(carved, which, truth);
  truth.mean_depth_mm = truth.volume_mm3 / truth.opening_area_mm2;
  truth.outline_mm = rimOf(carved, which);
  castGrid(carved, which, truth.outline_mm, truth);
  truth.perimeter_mm = lengthOf(truth.outline_mm);
  const CurveFigures figures = figuresOf(resampled(truth.outline_mm, 0.25), foot.toe - foot.heel);
  truth.projected_area_mm2 = figures.projected_area_mm2;
  truth.length_mm = figures.length_mm;
  truth.width_mm = figures.width_mm;
  truth.length_clock_mm = figures.length_clock_mm;
  truth.width_clock_mm = figures.width_clock_mm;
  truth.skin_curve_mm = skinCurve(carved, which, truth.outline_mm);
  orient(truth.skin_curve_mm, ulcer);
  return truth;
}

}  // namespace tarsus
