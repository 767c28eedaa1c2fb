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
  void fuseColor(const Eigen::Vector3f& p_color, float weight, int voxel, ColorBlock& colors) const;
  void fuseColors(const Eigen::Vector3f& first,
                  const std::array<float, kBlockVoxels>& distance_mm,
                  const std::array<float, kBlockVoxels>& quality,
                  ColorBlock& colors) const;

  const RgbdCamera& camera_;
  const DepthPlanes& planes_;
  const ColorImage* color_;
  TsdfWeighting weighting_;
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
  Eigen::Matrix3f color_from_scan_rotation_;
  Eigen::Vector3f color_from_scan_translation_;
  float voxel_size_mm_;
  float color_band_mm_;
};

}  // namespace tarsus
