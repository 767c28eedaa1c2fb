#include "reconstruction/scene/rigid_fit.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tarsus {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kKept = 0.8;      ///< share of pairs kept: the nearest; our choice
constexpr double kStillMm = 1e-5;  ///< a step that moves no point further than this ends it
constexpr std::size_t kFewestPairs = 6;

struct Pair {
  Eigen::Vector3d p;  ///< moved point of a
  Eigen::Vector3d q;  ///< nearest point of b
  Eigen::Vector3d normal;
  double distance_mm = std::numeric_limits<double>::infinity();
};

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

std::vector<Pair> pairUp(std::span<const Eigen::Vector3d> points_a,
                         const RigidTransform& b_from_a,
                         const TriangleMesh& b,
                         const MeshIndex& b_index) {
  std::vector<Pair> pairs(points_a.size());
  constexpr int kChunk = 512;
  const int count = static_cast<int>(points_a.size());
  parallelFor((count + kChunk - 1) / kChunk, [&](int chunk) {
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      Pair& pair = pairs[static_cast<std::size_t>(i)];
      pair.p = b_from_a * points_a[static_cast<std::size_t>(i)];
      const auto hit = b_index.nearest(pair.p, std::numeric_limits<double>::infinity());
      if (hit) {
        pair.q = hit->position_mm;
        pair.normal = faceNormal(b, static_cast<int>(hit->point.face));
        pair.distance_mm = hit->distance_mm;
      }
    }
  });
  std::erase_if(pairs, [](const Pair& pair) { return !std::isfinite(pair.distance_mm); });
  return pairs;
}

/// Keeps the nearest share, so that what only one surface has does not pull.
void trim(std::vector<Pair>& pairs) {
  const auto kept = static_cast<std::size_t>(kKept * static_cast<double>(pairs.size()));
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& left, const Pair& right) {
    return left.distance_mm < right.distance_mm;
  });
  pairs.resize(std::max(std::min(kFewestPairs, pairs.size()), kept));
}

/// One Gauss-Newton step of the sum of ((p - q) . n)^2, turning about the pairs' own middle.
std::optional<RigidTransform> solveStep(const std::vector<Pair>& pairs) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs) {
    middle += pair.p;
  }
  middle /= static_cast<double>(pairs.size());
  Matrix6 normal_matrix = Matrix6::Zero();
  Vector6 right_side = Vector6::Zero();
  for (const Pair& pair : pairs) {
    Vector6 row;
    row << (pair.p - middle).cross(pair.normal), pair.normal;
    normal_matrix += row * row.transpose();
    right_side += row * (pair.q - pair.p).dot(pair.normal);
  }
  // What the surface leaves free (a plane slides along itself) must stay where it is.
  normal_matrix.diagonal().array() += 1e-9 * normal_matrix.trace();
  const Vector6 step = normal_matrix.ldlt().solve(right_side);
  if (!step.allFinite()) {
    return std::nullopt;
  }
  const double angle = step.head<3>().norm();
  RigidTransform move = RigidTransform::Identity();
  move.translate(middle + step.tail<3>());
  if (angle > 0.0) {
    move.rotate(Eigen::AngleAxisd(angle, step.head<3>() / angle));
  }
  move.translate(-middle);
  return move;
}

double largestMove(const RigidTransform& move, const std::vector<Pair>& pairs) {
  double largest = 0.0;
  for (const Pair& pair : pairs) {
    largest = std::max(largest, (move * pair.p - pair.p).norm());
  }
  return largest;
}

}  // namespace

RigidTransform fitRigidly(std::span<const Eigen::Vector3d> points_a,
                          const TriangleMesh& b,
                          const MeshIndex& b_index) {
  RigidTransform b_from_a = RigidTransform::Identity();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    std::vector<Pair> pairs = pairUp(points_a, b_from_a, b, b_index);
    trim(pairs);
    if (pairs.size() < kFewestPairs) {
      break;
    }
    const auto move = solveStep(pairs);
    if (!move) {
      break;
    }
    b_from_a = *move * b_from_a;
    if (largestMove(*move, pairs) < kStillMm) {
      break;
    }
  }
  return b_from_a;
}

}  // namespace tarsus
