#pragma once

#include "reconstruction/fusion/block_grid.h"
#include "reconstruction/fusion/depth_planes.h"

namespace tarsus {

/// Fuses one frame into single blocks; safe to use from several threads on different blocks.
/// Private to fusion/.
class BlockUpdate {
 public:
  /// @param color  nullptr: no colour is fused
  BlockUpdate(const RgbdCamera& camera,
              const DepthPlanes& planes,
              const ColorImage* color,
              const RigidTransform& camera_from_scan,
              const TsdfOptions& options);

  void apply(BlockGrid& grid, int block) const;

 private:
  static constexpr int kLayer = kBlockSide * kBlockSide;
  /// Camera coordinates and pixel (-1: outside) of the voxels of one layer of a block.
  struct Layer {
    std::array<float, kLayer> x, y, z;
    std::array<std::int32_t, kLayer> pixel;
  };

  void project(const Eigen::Vector3f& first, Layer& layer) const;
  void fuse(const Layer& layer, int first_voxel, VoxelBlock& block, ColorBlock* colors) const;
  void fuseColor(const Eigen::Vector3f& p_camera,
                 float weight,
                 int voxel,
                 ColorBlock& colors) const;
  [[nodiscard]] float weightOf(float distance_mm) const;

  const RgbdCamera& camera_;
  const DepthPlanes& planes_;
  const ColorImage* color_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
  Eigen::Matrix3f color_rotation_;
  Eigen::Vector3f color_translation_;
  float voxel_size_mm_;
  float delta_mm_;
  float color_band_mm_;
  static constexpr int kWeightSteps = 1024;
  std::array<float, kWeightSteps + 1> weights_;  ///< over |d| from 0 to delta
  float weight_scale_;
};

}  // namespace tarsus
