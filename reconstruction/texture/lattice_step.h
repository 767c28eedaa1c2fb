#pragma once

#include "reconstruction/texture/patch_sums.h"

#include <memory>
#include <span>
#include <vector>

namespace tarsus {

/// How a lattice is held: squares count with these weights.
struct LatticePrior {
  double offset = 0.0;  ///< per px^2 of a node's offset
  double bend = 0.0;    ///< per px^2 of the difference between neighbours' offsets
};

/// Gauss-Newton steps of one picture's lattice. The pattern of its normal equations is always the
/// same and is analysed once.
class LatticeStep {
 public:
  explicit LatticeStep(const ControlLattice& warp);
  LatticeStep(LatticeStep&&) noexcept;
  LatticeStep& operator=(LatticeStep&&) noexcept;
  LatticeStep(const LatticeStep&) = delete;
  LatticeStep& operator=(const LatticeStep&) = delete;
  ~LatticeStep();

  /// @param cells  #nodes, by their upper left node; those of the last row and column are not used
  /// @return  #nodes changes of the offsets [px]; zero where the equations cannot be solved
  [[nodiscard]] std::vector<Eigen::Vector2f> solve(
      std::span<const std::array<double, kCellSums>> cells,
      const std::vector<Eigen::Vector2f>& offsets_px,
      const LatticePrior& prior);

 private:
  struct Equations;
  std::unique_ptr<Equations> equations_;
};

/// What the lattice's offsets add to the sum of squares.
[[nodiscard]] double priorEnergy(const ControlLattice& warp, const LatticePrior& prior);

}  // namespace tarsus
