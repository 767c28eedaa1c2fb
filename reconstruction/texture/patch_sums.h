#pragma once

#include "reconstruction/texture/sight_patches.h"

#include <array>
#include <span>
#include <vector>

namespace tarsus {

/// A picture at one size of the pyramid, placed.
struct PlacedImage {
  const Image<float>* intensity = nullptr;  ///< smoothed [grey levels]
  std::array<float, 9> rotation{};          ///< camera_from_scan, row by row
  std::array<float, 3> translation{};       ///< [mm]
  float fx_px = 0.0F;                       ///< of this size
  float fy_px = 0.0F;
  float cx_px = 0.0F;
  float cy_px = 0.0F;
  std::array<float, 3> pivot{};          ///< rigid steps turn about it [mm, camera]
  const ControlLattice* warp = nullptr;  ///< null: the picture does not bend
};

/// How well a run agrees with the means: Geman and McClure's loss of the residuals, and their
/// squares and weights as far as they are no outliers.
struct RobustSums {
  float loss = 0.0F;     ///< [grey levels^2]
  float squares = 0.0F;  ///< [grey levels^2]
  float weight = 0.0F;
};
template <std::size_t Count>
[[nodiscard]] RobustSums robustSums(const std::array<float, Count>& sums) {
  return {sums[Count - 3], sums[Count - 2], sums[Count - 1]};
}

/// Sums over one run's lines of sight: normal equations of a rigid step (motionOf in
/// rigid_motion.h), lower triangle row by row, then the right side, then as RobustSums.
inline constexpr std::size_t kRigidSums = 21 + 6 + 3;
using RigidSums = std::array<float, kRigidSums>;

/// The same for the four nodes of a lattice cell: for each pair of nodes (0 0, 1 0, 1 1, 2 0, ...)
/// the products of slopes uu, uv, vv; for each node the right side u, v; then as RobustSums.
inline constexpr std::size_t kCellSums = 10 * 3 + 4 * 2 + 3;
using CellSums = std::array<float, kCellSums>;

/// What the pictures show at the lines of sight of one block.
struct alignas(32) SightSample {
  std::array<float, kLanes> value, du, dv;  ///< [grey levels], [grey levels per px]
  std::array<float, kLanes> x, y, z;        ///< in the camera [mm]
  std::array<float, kLanes> right, down;    ///< share of the cell's right and lower nodes
};

struct WeightedSum {
  float weight = 0.0F;
  float value = 0.0F;
};

/// Works through one patch: its vertices' grey levels from all pictures, and from them what each
/// picture lacks. Room that is used again from patch to patch.
class PatchSums {
 public:
  /// Residuals of this size count a quarter, far larger ones nothing [grey levels].
  void useOutlierLevels(float levels) { outlier_levels_ = levels; }

  /// Samples all pictures.
  void sample(const SightPatch& patch, std::span<const PlacedImage> images);
  /// Weighted mean of the samples of each vertex; those far from `centers` count less.
  /// @param centers  #vertices of the patch; empty: around the plain means
  /// @param wanted   #vertices of the patch, written
  void average(const SightPatch& patch, std::span<const float> centers, std::span<float> wanted);
  /// @param sums  #runs of the patch, written
  void sumRigid(const SightPatch& patch,
                std::span<const PlacedImage> images,
                std::span<const float> wanted,
                std::span<RigidSums> sums) const;
  void sumCells(const SightPatch& patch,
                std::span<const float> wanted,
                std::span<CellSums> sums) const;

 private:
  float outlier_levels_ = 16.0F;
  std::vector<SightSample> samples_;
  std::vector<WeightedSum> weighted_sums_;
  std::vector<float> plain_means_;
};

}  // namespace tarsus
