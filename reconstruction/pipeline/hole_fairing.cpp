#include "reconstruction/pipeline/hole_fairing.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

double cotangent(const Vector3d& apex, const Vector3d& a, const Vector3d& b) {
  const Vector3d u = a - apex;
  const Vector3d v = b - apex;
  const double sine = u.cross(v).norm();
  // Slivers of marching cubes have cotangents without bound; they would outweigh all others.
  constexpr double kLargest = 8.0;
  return std::clamp(u.dot(v) / std::max(sine, 1e-12), -0.5, kLargest);
}

struct Operators {
  SparseMatrix laplacian;  ///< integrated; rows of outer points are empty
  SparseMatrix stiffness;  ///< of the faces whose corners are all inner points
  Eigen::VectorXd area_mm2;
};

/// Source: Meyer et al., Discrete differential-geometry operators, 2003 (cotangent weights).
Operators operatorsOn(const std::vector<Vector3d>& points, const FairingPatch& patch) {
  const auto count = static_cast<Eigen::Index>(points.size());
  Operators result{
      SparseMatrix(count, count), SparseMatrix(count, count), Eigen::VectorXd::Zero(count)};
  Triplets stiff;
  Triplets entries;
  const auto add = [&](int row, int other, double weight) {
    if (patch.inner[static_cast<std::size_t>(row)] != 0) {
      entries.emplace_back(row, other, weight);
      entries.emplace_back(row, row, -weight);
    }
  };
  for (const Eigen::Vector3i& f : patch.faces) {
    const auto at = [&](int k) -> const Vector3d& {
      return points[static_cast<std::size_t>(f[k])];
    };
    const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    const bool all_inner = patch.inner[static_cast<std::size_t>(f[0])] != 0 &&
                           patch.inner[static_cast<std::size_t>(f[1])] != 0 &&
                           patch.inner[static_cast<std::size_t>(f[2])] != 0;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3;
      const int b = (k + 2) % 3;
      const double weight = 0.5 * cotangent(at(k), at(a), at(b));
      add(f[a], f[b], weight);
      add(f[b], f[a], weight);
      if (all_inner) {
        stiff.emplace_back(f[a], f[b], -weight);
        stiff.emplace_back(f[b], f[a], -weight);
        stiff.emplace_back(f[a], f[a], weight);
        stiff.emplace_back(f[b], f[b], weight);
      }
      result.area_mm2[f[k]] += area / 3.0;
    }
  }
  result.laplacian.setFromTriplets(entries.begin(), entries.end());
  result.stiffness.setFromTriplets(stiff.begin(), stiff.end());
  const double least = 0.1 * result.area_mm2.mean();
  result.area_mm2 = result.area_mm2.cwiseMax(std::max(least, 1e-12));
  return result;
}

bool solveOnce(const FairingPatch& patch, double smoothing_mm, std::vector<Vector3d>& points) {
  const Operators operators = operatorsOn(points, patch);
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd tie(count);
  Eigen::MatrixXd right(count, 3);
  const double stiffness = 1.0 / std::pow(smoothing_mm, 6);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    tie[i] = patch.trust[k] * stiffness * operators.area_mm2[i];
    right.row(i) = tie[i] * patch.points[k].transpose();
  }
  const SparseMatrix curvature =
      operators.area_mm2.cwiseInverse().asDiagonal() * operators.laplacian;
  SparseMatrix system = SparseMatrix(curvature.transpose()) * operators.stiffness * curvature;
  system += SparseMatrix(tie.asDiagonal());
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  if (solver.info() != Eigen::Success) {
    return false;
  }
  const Eigen::MatrixXd solution = solver.solve(right);
  if (solver.info() != Eigen::Success || !solution.allFinite()) {
    return false;
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    points[static_cast<std::size_t>(i)] = solution.row(i).transpose();
  }
  return true;
}

}  // namespace

std::vector<Vector3d> fairedPoints(const FairingPatch& patch, double smoothing_mm) {
  // The weights come from the shape: the flat first filling gives the second its shape.
  constexpr int kRounds = 2;
  std::vector<Vector3d> points = patch.points;
  for (int round = 0; round < kRounds; ++round) {
    if (!solveOnce(patch, smoothing_mm, points)) {
      return {};
    }
  }
  return points;
}

}  // namespace tarsus
