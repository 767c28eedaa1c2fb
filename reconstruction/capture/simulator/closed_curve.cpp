#include "reconstruction/capture/simulator/closed_curve.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace tarsus {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Eigen::Vector3d;

struct Plane {
  Vector3d middle;
  Vector3d normal;
};

Plane bestFitPlane(std::span<const Vector3d> points) {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : points) {
    middle += p;
  }
  middle /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) {
    scatter += (p - middle) * (p - middle).transpose();
  }
  return {middle, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0)};
}

/// Longest run across the polygon parallel to the y axis, between its outermost crossings.
double widestAcross(const std::vector<Vector2d>& polygon) {
  double best = 0.0;
  for (const Vector2d& at : polygon) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d& a = polygon[i];
      const Vector2d& b = polygon[(i + 1) % polygon.size()];
      if ((a.x() <= at.x()) == (b.x() <= at.x())) {
        continue;
      }
      const double y = a.y() + (at.x() - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
      low = std::min(low, y);
      high = std::max(high, y);
    }
    best = std::max(best, high - low);
  }
  return best;
}

std::vector<Vector2d> inPlane(std::span<const Vector3d> curve,
                              const Plane& plane,
                              const Vector3d& x_axis) {
  const Vector3d y_axis = plane.normal.cross(x_axis);
  std::vector<Vector2d> flat;
  flat.reserve(curve.size());
  for (const Vector3d& p : curve) {
    flat.emplace_back((p - plane.middle).dot(x_axis), (p - plane.middle).dot(y_axis));
  }
  return flat;
}

Vector3d across(const Vector3d& direction, const Vector3d& normal) {
  return (direction - direction.dot(normal) * normal).normalized();
}

}  // namespace

double lengthOf(std::span<const Vector3d> curve) {
  double length = 0.0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    length += (curve[(i + 1) % curve.size()] - curve[i]).norm();
  }
  return length;
}

ClosedCurve resampled(std::span<const Vector3d> curve, double spacing_mm) {
  const double length = lengthOf(curve);
  const int count = std::max(3, static_cast<int>(std::lround(length / spacing_mm)));
  ClosedCurve out;
  double walked = 0.0;
  for (std::size_t i = 0; i < curve.size() && static_cast<int>(out.size()) < count; ++i) {
    const Vector3d& a = curve[i];
    const Vector3d& b = curve[(i + 1) % curve.size()];
    const double step = (b - a).norm();
    while (static_cast<int>(out.size()) < count) {
      const double next = length * static_cast<double>(out.size()) / count;
      if (next > walked + step) {
        break;
      }
      out.push_back(step > 0.0 ? a + (next - walked) / step * (b - a) : a);
    }
    walked += step;
  }
  return out;
}

std::vector<std::vector<int>> joinLoops(std::span<const Vector2i> pieces) {
  std::map<int, std::vector<int>> neighbours;
  for (const Vector2i& piece : pieces) {
    neighbours[piece.x()].push_back(piece.y());
    neighbours[piece.y()].push_back(piece.x());
  }
  std::vector<std::vector<int>> loops;
  while (!neighbours.empty()) {
    std::vector<int> loop = {neighbours.begin()->first};
    for (;;) {
      auto here = neighbours.find(loop.back());
      if (here == neighbours.end() || here->second.empty()) {
        break;
      }
      const int next = here->second.back();
      here->second.pop_back();
      auto& back = neighbours[next];
      back.erase(std::ranges::find(back, loop.back()));
      if (next == loop.front()) {
        break;
      }
      loop.push_back(next);
    }
    for (const int name : loop) {
      if (const auto it = neighbours.find(name); it != neighbours.end() && it->second.empty()) {
        neighbours.erase(it);
      }
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

double distanceTo(std::span<const Vector3d> curve, const Vector3d& p) {
  double best2 = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vector3d& a = curve[i];
    const Vector3d side = curve[(i + 1) % curve.size()] - a;
    const double t = std::clamp((p - a).dot(side) / std::max(side.squaredNorm(), 1e-18), 0.0, 1.0);
    best2 = std::min(best2, (p - a - t * side).squaredNorm());
  }
  return std::sqrt(best2);
}

CurveFigures figuresOf(std::span<const Vector3d> curve, const Vector3d& heel_toe) {
  CurveFigures figures;
  const Plane plane = bestFitPlane(curve);
  Vector3d chord = Vector3d::Zero();
  for (std::size_t i = 0; i < curve.size(); ++i) {
    for (std::size_t k = i + 1; k < curve.size(); ++k) {
      if ((curve[i] - curve[k]).squaredNorm() > chord.squaredNorm()) {
        chord = curve[i] - curve[k];
      }
    }
  }
  figures.length_mm = chord.norm();
  const std::vector<Vector2d> along_chord = inPlane(curve, plane, across(chord, plane.normal));
  double twice_area = 0.0;
  for (std::size_t i = 0; i < along_chord.size(); ++i) {
    const Vector2d& a = along_chord[i];
    const Vector2d& b = along_chord[(i + 1) % along_chord.size()];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  figures.projected_area_mm2 = 0.5 * std::abs(twice_area);
  figures.width_mm = widestAcross(along_chord);

  std::vector<Vector2d> clock = inPlane(curve, plane, across(heel_toe, plane.normal));
  figures.width_clock_mm = widestAcross(clock);
  for (Vector2d& p : clock) {
    p = {p.y(), p.x()};
  }
  figures.length_clock_mm = widestAcross(clock);
  return figures;
}

}  // namespace tarsus
