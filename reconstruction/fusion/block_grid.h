#pragma once

#include "reconstruction/fusion/tsdf_volume.h"

#include <array>
#include <limits>
#include <span>

namespace tarsus {

inline constexpr int kBlockSide = 8;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

/// 8^3 voxels; x runs fastest. Private to fusion/.
struct VoxelBlock {
  std::array<float, kBlockVoxels> distance_mm;  ///< NaN where never observed
  std::array<float, kBlockVoxels> weight;
  /// Weighted sum of squared deviations of the observed distances (West 1979).
  std::array<float, kBlockVoxels> deviation_mm2;
  std::array<std::uint16_t, kBlockVoxels> observations;

  VoxelBlock() {
    distance_mm.fill(std::numeric_limits<float>::quiet_NaN());
    weight.fill(0.0F);
    deviation_mm2.fill(0.0F);
    observations.fill(0);
  }
};

/// Colours of a block's voxels, kept apart since tracking needs none.
struct ColorBlock {
  std::array<std::array<float, 3>, kBlockVoxels> rgb{};
  std::array<float, kBlockVoxels> weight{};
};

/// Sparse grid of blocks with a two-level dense index. Voxel (i, j, k) stands at
/// (i, j, k) * voxel size in the scan frame. Private to fusion/.
class BlockGrid {
 public:
  BlockGrid(float voxel_size_mm, bool with_color);

  [[nodiscard]] float voxelSize() const { return voxel_size_mm_; }
  [[nodiscard]] int blockCount() const { return static_cast<int>(blocks_.size()); }
  [[nodiscard]] bool hasColor() const { return with_color_; }
  [[nodiscard]] VoxelBlock& block(int i) { return *blocks_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const VoxelBlock& block(int i) const {
    return *blocks_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] ColorBlock& colors(int i) { return *colors_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const ColorBlock& colors(int i) const {
    return *colors_[static_cast<std::size_t>(i)];
  }
  /// Block coordinates: those of its first voxel divided by 8.
  [[nodiscard]] const Eigen::Vector3i& coordinates(int i) const {
    return coordinates_[static_cast<std::size_t>(i)];
  }

  /// Number of the block at these coordinates, -1 where there is none.
  [[nodiscard]] int find(const Eigen::Vector3i& at) const {
    const int slot = regionSlot(at);
    const int region = slot < 0 ? 0 : regions_of_[static_cast<std::size_t>(slot)];
    return region == 0 ? -1 : regions_[static_cast<std::size_t>(region - 1)][inRegion(at)];
  }
  /// The same, made where there is none; -1 only outside the index (several metres away).
  int findOrAdd(const Eigen::Vector3i& at);

  /// Distance of one voxel, NaN where unobserved.
  [[nodiscard]] float distanceAt(const Eigen::Vector3i& voxel) const {
    const int i = find({voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3});
    return i < 0 ? std::numeric_limits<float>::quiet_NaN()
                 : block(i).distance_mm[voxelInBlock(voxel)];
  }
  [[nodiscard]] static std::size_t voxelInBlock(const Eigen::Vector3i& voxel) {
    return static_cast<std::size_t>((voxel.x() & 7) | ((voxel.y() & 7) << 3) |
                                    ((voxel.z() & 7) << 6));
  }

  /// Trilinear value and gradient; false where a corner was never observed.
  [[nodiscard]] bool sample(const Eigen::Vector3f& p_scan, SdfSample& result) const;
  [[nodiscard]] std::size_t memoryBytes() const;

 private:
  using Corners = std::array<float, 8>;
  /// Distances at the corners of the cell from v on, where it crosses blocks; false without them.
  [[nodiscard]] bool cornersAcrossBlocks(const Eigen::Vector3i& v, Corners& corners) const;

  static constexpr int kRegionBits = 4;  ///< a region is 16^3 blocks
  static constexpr int kTopBits = 7;     ///< the index covers 128^3 regions around the origin
  using Region = std::array<std::int32_t, 1 << (3 * kRegionBits)>;

  [[nodiscard]] static int regionSlot(const Eigen::Vector3i& at) {
    constexpr int kHalf = 1 << (kTopBits - 1);
    const int x = (at.x() >> kRegionBits) + kHalf;
    const int y = (at.y() >> kRegionBits) + kHalf;
    const int z = (at.z() >> kRegionBits) + kHalf;
    constexpr int kSide = 1 << kTopBits;
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < kSide && y < kSide && z < kSide;
    return inside ? x | (y << kTopBits) | (z << (2 * kTopBits)) : -1;
  }
  [[nodiscard]] static std::size_t inRegion(const Eigen::Vector3i& at) {
    constexpr int kMask = (1 << kRegionBits) - 1;
    return static_cast<std::size_t>((at.x() & kMask) | ((at.y() & kMask) << kRegionBits) |
                                    ((at.z() & kMask) << (2 * kRegionBits)));
  }

  float voxel_size_mm_;
  float inverse_voxel_size_;
  bool with_color_;
  std::vector<std::int32_t> regions_of_;  ///< number of the region plus 1, 0 = none
  std::vector<Region> regions_;
  std::vector<std::unique_ptr<VoxelBlock>> blocks_;
  std::vector<std::unique_ptr<ColorBlock>> colors_;
  std::vector<Eigen::Vector3i> coordinates_;
};

struct TsdfVolume::Grid {
  explicit Grid(const TsdfOptions& volume_options)
      : options(volume_options),
        blocks(static_cast<float>(volume_options.voxel_size_mm), volume_options.with_color) {}
  /// Numbers of the blocks that a frame may concern.
  [[nodiscard]] std::vector<int> blocksInView(const DepthPlanes& planes,
                                              const RigidTransform& scan_from_camera);

  TsdfOptions options;
  BlockGrid blocks;
  bool confined = false;                 ///< frames add no blocks
  std::vector<int> last_frame_of_block;  ///< to list each block once per frame
  std::vector<int> changed_at;           ///< by block: the last frame that reached it, from 1 on
  int frames = 0;
};

/// Marching cubes; extract_surface.cpp.
[[nodiscard]] ExtractedSurface extractFromGrid(const BlockGrid& grid, float min_weight);

}  // namespace tarsus
