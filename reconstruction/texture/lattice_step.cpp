#include "reconstruction/texture/lattice_step.h"

#include <Eigen/SparseCholesky>

namespace tarsus {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr double kMaxStep_px = 4.0;

/// Calls use(a, b) for neighbouring nodes a > b.
template <typename Use>
void eachNeighbour(int columns, int rows, const Use& use) {
  for (int i = 0; i < columns * rows; ++i) {
    if (i % columns != 0) {
      use(i, i - 1);
    }
    if (i >= columns) {
      use(i, i - columns);
    }
  }
}

}  // namespace

struct LatticeStep::Equations {
  int columns = 0;
  int rows = 0;
  Triplets triplets;
  Eigen::VectorXd right;
  Eigen::SimplicialLDLT<Sparse> solver;
  bool analysed = false;

  void addCell(int first, const std::array<double, kCellSums>& sums);
  void addPrior(const std::vector<Eigen::Vector2f>& offsets, const LatticePrior& prior);
  void pull(int node, const Eigen::Vector2f& towards, double weight) {
    right.segment<2>(2 * node) += weight * towards.cast<double>();
  }
};

void LatticeStep::Equations::addCell(int first, const std::array<double, kCellSums>& sums) {
  const std::array<int, 4> node{first, first + 1, first + columns, first + columns + 1};
  std::size_t index = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j <= i; ++j, index += 3) {
      const int a = 2 * node[i];
      const int b = 2 * node[j];
      triplets.emplace_back(a, b, sums[index]);
      triplets.emplace_back(a + 1, b, sums[index + 1]);
      triplets.emplace_back(a + 1, b + 1, sums[index + 2]);
      if (i != j) {
        triplets.emplace_back(a, b + 1, sums[index + 1]);
      }
    }
    right[2 * node[i]] += sums[30 + 2 * i];
    right[2 * node[i] + 1] += sums[31 + 2 * i];
  }
}

void LatticeStep::Equations::addPrior(const std::vector<Eigen::Vector2f>& offsets,
                                      const LatticePrior& prior) {
  for (int i = 0; i < columns * rows; ++i) {
    triplets.emplace_back(2 * i, 2 * i, prior.offset);
    triplets.emplace_back(2 * i + 1, 2 * i + 1, prior.offset);
    pull(i, -offsets[static_cast<std::size_t>(i)], prior.offset);
  }
  eachNeighbour(columns, rows, [&](int a, int b) {
    for (int k = 0; k < 2; ++k) {
      triplets.emplace_back(2 * a + k, 2 * a + k, prior.bend);
      triplets.emplace_back(2 * b + k, 2 * b + k, prior.bend);
      triplets.emplace_back(2 * a + k, 2 * b + k, -prior.bend);
    }
    const Eigen::Vector2f bent =
        offsets[static_cast<std::size_t>(a)] - offsets[static_cast<std::size_t>(b)];
    pull(a, -bent, prior.bend);
    pull(b, bent, prior.bend);
  });
}

LatticeStep::LatticeStep(const ControlLattice& warp) : equations_(std::make_unique<Equations>()) {
  equations_->columns = warp.columns();
  equations_->rows = warp.rows();
}
LatticeStep::LatticeStep(LatticeStep&&) noexcept = default;
LatticeStep& LatticeStep::operator=(LatticeStep&&) noexcept = default;
LatticeStep::~LatticeStep() = default;

std::vector<Eigen::Vector2f> LatticeStep::solve(
    std::span<const std::array<double, kCellSums>> cells,
    const std::vector<Eigen::Vector2f>& offsets_px,
    const LatticePrior& prior) {
  Equations& e = *equations_;
  const auto size = static_cast<Eigen::Index>(2 * offsets_px.size());
  e.triplets.clear();
  e.right.setZero(size);
  for (int first = 0; first < e.columns * (e.rows - 1); ++first) {
    if (first % e.columns != e.columns - 1) {
      e.addCell(first, cells[static_cast<std::size_t>(first)]);
    }
  }
  e.addPrior(offsets_px, prior);
  Sparse normal(size, size);
  normal.setFromTriplets(e.triplets.begin(), e.triplets.end());
  if (!e.analysed) {
    e.solver.analyzePattern(normal);
    e.analysed = true;
  }
  e.solver.factorize(normal);
  const Eigen::VectorXd solution = e.solver.solve(e.right);
  std::vector<Eigen::Vector2f> steps(offsets_px.size(), Eigen::Vector2f::Zero());
  if (e.solver.info() != Eigen::Success || !solution.allFinite()) {
    return steps;
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Eigen::Vector2d step = solution.segment<2>(2 * static_cast<Eigen::Index>(i));
    const double size_px = step.norm();
    const double share = size_px > kMaxStep_px ? kMaxStep_px / size_px : 1.0;
    steps[i] = (share * step).cast<float>();
  }
  return steps;
}

double priorEnergy(const ControlLattice& warp, const LatticePrior& prior) {
  const std::vector<Eigen::Vector2f>& offsets = warp.offsets_px();
  double offset_px2 = 0.0;
  double bend_px2 = 0.0;
  for (const Eigen::Vector2f& offset : offsets) {
    offset_px2 += static_cast<double>(offset.squaredNorm());
  }
  eachNeighbour(warp.columns(), warp.rows(), [&](int a, int b) {
    const Eigen::Vector2f bent =
        offsets[static_cast<std::size_t>(a)] - offsets[static_cast<std::size_t>(b)];
    bend_px2 += static_cast<double>(bent.squaredNorm());
  });
  return prior.offset * offset_px2 + prior.bend * bend_px2;
}

}  // namespace tarsus
