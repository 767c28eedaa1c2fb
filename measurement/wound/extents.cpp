#include "measurement/wound/extents.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Eigen::Vector2d> hull;
  const auto append = [&](const Eigen::Vector2d& p, std::size_t keep) {
    while (hull.size() > keep &&
           cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const auto& p : points) {
    append(p, 1);
  }
  const std::size_t lower = hull.size();
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it) {
    append(*it, lower);
  }
  hull.pop_back();
  return hull;
}

/// Length of the outline's section at right angles to `along`, through the point at `x` along it:
/// from edge to opposite edge, as a ruler is laid, also where a concave outline runs between.
double section(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& along, double x) {
  const Eigen::Vector2d across(-along.y(), along.x());
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d& a = points[i];
    const Eigen::Vector2d& b = points[(i + 1) % points.size()];
    const double xa = a.dot(along) - x;
    const double xb = b.dot(along) - x;
    if ((xa > 0.0 && xb > 0.0) || (xa < 0.0 && xb < 0.0)) {
      continue;
    }
    const double t = xa != xb ? xa / (xa - xb) : 0.0;
    const double y = ((1.0 - t) * a + t * b).dot(across);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return std::max(0.0, high - low);
}

/// The longest of the sections at right angles to `along`. Between two corners a section changes
/// linearly, so one of those through a corner is the longest.
double longestAcross(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& along) {
  double longest = 0.0;
  for (const auto& p : points) {
    longest = std::max(longest, section(points, along, p.dot(along)));
  }
  return longest;
}

}  // namespace

FlatOutline flatten(std::span<const Eigen::Vector3d> closed_mm, const Eigen::Vector3d& outward) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double length = 0.0;
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < closed_mm.size(); ++i) {
      const Eigen::Vector3d& a = closed_mm[i];
      const Eigen::Vector3d& b = closed_mm[(i + 1) % closed_mm.size()];
      visit(Eigen::Vector3d(0.5 * (a + b)), (b - a).norm());
    }
  };
  each([&](const Eigen::Vector3d& p, double w) {
    middle += w * p;
    length += w;
  });
  middle /= length;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  each([&](const Eigen::Vector3d& p, double w) {
    spread += w * (p - middle) * (p - middle).transpose();
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  Eigen::Vector3d normal = axes.eigenvectors().col(0);
  if (normal.dot(outward) < 0.0) {
    normal = -normal;
  }
  FlatOutline flat;
  flat.right = axes.eigenvectors().col(2);
  flat.up = normal.cross(flat.right);
  for (const auto& p : closed_mm) {
    flat.points.emplace_back((p - middle).dot(flat.right), (p - middle).dot(flat.up));
  }
  return flat;
}

double areaOf(const FlatOutline& outline) {
  double twice = 0.0;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    twice += cross(outline.points[i], outline.points[(i + 1) % outline.points.size()]);
  }
  return 0.5 * std::abs(twice);
}

LengthWidth greatestChords(const FlatOutline& outline) {
  const auto hull = convexHull(outline.points);
  LengthWidth result;
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    for (std::size_t j = i + 1; j < hull.size(); ++j) {
      const double d = (hull[j] - hull[i]).norm();
      if (d > result.length_mm) {
        result.length_mm = d;
        along = (hull[j] - hull[i]) / d;
      }
    }
  }
  result.width_mm = longestAcross(outline.points, along);
  return result;
}

LengthWidth chordsAlong(const FlatOutline& outline, const Eigen::Vector3d& axis) {
  const Eigen::Vector2d along =
      Eigen::Vector2d(axis.dot(outline.right), axis.dot(outline.up)).normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  return {.length_mm = longestAcross(outline.points, across),
          .width_mm = longestAcross(outline.points, along)};
}

}  // namespace tarsus
