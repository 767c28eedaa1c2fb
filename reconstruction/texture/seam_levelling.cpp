#include "reconstruction/texture/seam_levelling.h"

#include <Eigen/SparseCholesky>

namespace tarsus {
namespace {

using Triplet = Eigen::Triplet<double>;

/// weight * (x_i - x_j + wanted)^2, for the three channels at once.
struct NormalEquations {
  explicit NormalEquations(Eigen::Index count) : right(Eigen::MatrixX3d::Zero(count, 3)) {}

  void couple(int i, int j, double weight, const Eigen::Vector3d& wanted) {
    entries.emplace_back(i, i, weight);
    entries.emplace_back(j, j, weight);
    entries.emplace_back(std::max(i, j), std::min(i, j), -weight);
    right.row(i) -= weight * wanted.transpose();
    right.row(j) += weight * wanted.transpose();
  }

  std::vector<Triplet> entries;  // lower half
  Eigen::MatrixX3d right;
};

/// A step so large counts half [grey levels]: no exposure makes it, something else was seen there.
constexpr double kOddStep = 25.0;

void addSeam(const SeamEdge& seam, double weight, NormalEquations& equations) {
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();
  const auto count = static_cast<double>(seam.step.size());
  for (std::size_t k = 0; k < seam.step.size(); ++k) {
    const double t = (static_cast<double>(k) + 0.5) / count;
    first += (1.0 - t) * seam.step[k].cast<double>();
    second += t * seam.step[k].cast<double>();
  }
  const double odd = (first + second).norm() / count / kOddStep;
  weight /= 1.0 + odd * odd;
  // Each half of the weights sums to half the number of samples.
  equations.couple(seam.first_uv, seam.other_first_uv, weight, 2.0 / count * first);
  equations.couple(seam.second_uv, seam.other_second_uv, weight, 2.0 / count * second);
}

}  // namespace

std::vector<Eigen::Vector3f> levelSeams(std::span<const Chart> charts,
                                        std::span<const SeamEdge> seams,
                                        const SeamLevellingOptions& options) {
  Eigen::Index count = 0;
  for (const Chart& chart : charts) {
    count += static_cast<Eigen::Index>(chart.vertices.size());
  }
  NormalEquations equations(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    equations.entries.emplace_back(i, i, options.anchor_weight);
  }
  int first = 0;
  for (const Chart& chart : charts) {
    for (const Eigen::Vector3i& corner : chart.corners) {
      for (int k = 0; k < 3; ++k) {
        // An edge within the chart comes twice.
        equations.couple(
            first + corner[k], first + corner[(k + 1) % 3], 0.5, Eigen::Vector3d::Zero());
      }
    }
    first += static_cast<int>(chart.vertices.size());
  }
  for (const SeamEdge& seam : seams) {
    addSeam(seam, 0.5 * options.seam_weight, equations);
  }
  Eigen::SparseMatrix<double> normal(count, count);
  normal.setFromTriplets(equations.entries.begin(), equations.entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  if (solver.info() != Eigen::Success) {
    return {};
  }
  const Eigen::MatrixX3d solution = solver.solve(equations.right);
  std::vector<Eigen::Vector3f> offsets(static_cast<std::size_t>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    offsets[static_cast<std::size_t>(i)] = solution.row(i).transpose().cast<float>();
  }
  return offsets;
}

}  // namespace tarsus
