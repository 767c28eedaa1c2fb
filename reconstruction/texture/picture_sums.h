#pragma once

#include "reconstruction/scene/rigid_motion.h"
#include "reconstruction/texture/patch_sums.h"

#include <span>
#include <vector>

namespace tarsus {

/// Normal equations of one picture's rigid step.
struct RigidEquations {
  MotionMatrix normal = MotionMatrix::Zero();
  MotionVector right = MotionVector::Zero();
};

/// Of one lattice, by the cells' upper left nodes: as CellSums.
using CellEquations = std::vector<std::array<double, kCellSums>>;

/// RobustSums of all runs together.
struct Agreement {
  double loss = 0.0;  ///< [grey levels^2]
  double squares = 0.0;
  double weight = 0.0;

  void add(const RobustSums& sums) {
    loss += static_cast<double>(sums.loss);
    squares += static_cast<double>(sums.squares);
    weight += static_cast<double>(sums.weight);
  }
  /// Mean square of residuals that are no outliers [grey levels^2].
  [[nodiscard]] double variance() const { return weight > 0.0 ? squares / weight : 0.0; }
};

/// All patches: what the pictures say together, and what each of them lacks.
class PictureSums {
 public:
  enum class Kind { Rigid, Cells };

  PictureSums(std::vector<SightPatch> patches,
              std::size_t picture_count,
              Kind kind,
              float outlier_levels);

  /// Samples the pictures where they lie now and compares each with the mean of all; vertices whose
  /// mean was kept take the new one around that.
  Agreement evaluate(std::span<const PlacedImage> images);
  /// Keeps the means of the last evaluation.
  void keepMeans() { centers_ = wanted_; }

  [[nodiscard]] std::vector<RigidEquations> rigidEquations() const;
  [[nodiscard]] std::vector<CellEquations> cellEquations(std::size_t nodes) const;

  /// Sum of the weights of each picture's lines of sight.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }
  [[nodiscard]] double totalWeight() const { return total_weight_; }
  [[nodiscard]] std::size_t observations() const { return observations_; }

 private:
  void evaluatePatch(std::size_t i, std::span<const PlacedImage> images);

  std::vector<SightPatch> patches_;
  Kind kind_;
  float outlier_levels_;
  std::vector<std::size_t> first_run_;     ///< of each patch, in the sums
  std::vector<std::size_t> first_vertex_;  ///< of each patch, in the grey levels
  std::vector<double> weights_;
  double total_weight_ = 0.0;
  std::size_t observations_ = 0;
  std::vector<float> wanted_;
  std::vector<float> centers_;
  std::vector<RigidSums> rigid_sums_;
  std::vector<CellSums> cell_sums_;
};

}  // namespace tarsus
