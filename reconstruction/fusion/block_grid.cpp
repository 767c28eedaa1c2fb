#include "reconstruction/fusion/block_grid.h"

#include "reconstruction/base/require.h"

#include <cmath>

namespace tarsus {
namespace {

/// Value and gradient of the trilinear interpolant; corner i stands at the bits of i.
inline bool interpolate(const std::array<float, 8>& c,
                        const Eigen::Vector3f& t,
                        float per_mm,
                        SdfSample& result) {
  const float x00 = c[0] + t.x() * (c[1] - c[0]);
  const float x10 = c[2] + t.x() * (c[3] - c[2]);
  const float x01 = c[4] + t.x() * (c[5] - c[4]);
  const float x11 = c[6] + t.x() * (c[7] - c[6]);
  const float y0 = x00 + t.y() * (x10 - x00);
  const float y1 = x01 + t.y() * (x11 - x01);
  const float value = y0 + t.z() * (y1 - y0);
  if (std::isnan(value)) {
    return false;
  }
  const float dx0 = (c[1] - c[0]) + t.y() * ((c[3] - c[2]) - (c[1] - c[0]));
  const float dx1 = (c[5] - c[4]) + t.y() * ((c[7] - c[6]) - (c[5] - c[4]));
  const float dy0 = x10 - x00;
  const float dy1 = x11 - x01;
  result.distance_mm = value;
  result.gradient =
      Eigen::Vector3f(dx0 + t.z() * (dx1 - dx0), dy0 + t.z() * (dy1 - dy0), y1 - y0) * per_mm;
  return true;
}

}  // namespace

BlockGrid::BlockGrid(float voxel_size_mm, bool with_color)
    : voxel_size_mm_(voxel_size_mm),
      inverse_voxel_size_(1.0F / voxel_size_mm),
      with_color_(with_color),
      regions_of_(std::size_t{1} << (3 * kTopBits)) {
  TARSUS_REQUIRE(voxel_size_mm > 0.0F, "voxels have a size");
}

int BlockGrid::findOrAdd(const Eigen::Vector3i& at) {
  const int slot = regionSlot(at);
  if (slot < 0) {
    return -1;
  }
  std::int32_t& region = regions_of_[static_cast<std::size_t>(slot)];
  if (region == 0) {
    regions_.emplace_back().fill(-1);
    region = static_cast<std::int32_t>(regions_.size());
  }
  std::int32_t& number = regions_[static_cast<std::size_t>(region - 1)][inRegion(at)];
  if (number < 0) {
    number = static_cast<std::int32_t>(blocks_.size());
    blocks_.push_back(std::make_unique<VoxelBlock>());
    coordinates_.push_back(at);
    if (with_color_) {
      colors_.push_back(std::make_unique<ColorBlock>());
    }
  }
  return number;
}

bool BlockGrid::sample(const Eigen::Vector3f& p_scan, SdfSample& result) const {
  const Eigen::Vector3f g = p_scan * inverse_voxel_size_;
  const Eigen::Vector3f lower(std::floor(g.x()), std::floor(g.y()), std::floor(g.z()));
  const Eigen::Vector3f t = g - lower;
  const Eigen::Vector3i v = lower.cast<int>();
  const int number = find({v.x() >> 3, v.y() >> 3, v.z() >> 3});
  if (number < 0) {
    return false;
  }
  const std::size_t first = voxelInBlock(v);
  const float* const d = block(number).distance_mm.data() + first;
  if (std::isnan(d[0])) {
    return false;
  }
  Corners corners;
  if ((v.x() & 7) < 7 && (v.y() & 7) < 7 && (v.z() & 7) < 7) {
    return interpolate(
        {d[0], d[1], d[8], d[9], d[64], d[65], d[72], d[73]}, t, inverse_voxel_size_, result);
  }
  return cornersAcrossBlocks(v, corners) && interpolate(corners, t, inverse_voxel_size_, result);
}

bool BlockGrid::cornersAcrossBlocks(const Eigen::Vector3i& v, Corners& corners) const {
  const std::array<int, 3> at{v.x() & 7, v.y() & 7, v.z() & 7};
  const int crossing = (at[0] == 7 ? 1 : 0) | (at[1] == 7 ? 2 : 0) | (at[2] == 7 ? 4 : 0);
  // One look-up for each block that the cell reaches into: 2, 4 or 8.
  std::array<const float*, 8> blocks{};
  for (int i = 0; i < 8; ++i) {
    if ((i & ~crossing) == 0) {
      const int number =
          find({(v.x() >> 3) + (i & 1), (v.y() >> 3) + ((i >> 1) & 1), (v.z() >> 3) + (i >> 2)});
      if (number < 0) {
        return false;
      }
      blocks[static_cast<std::size_t>(i)] = block(number).distance_mm.data();
    }
  }
  for (int i = 0; i < 8; ++i) {
    const int x = (at[0] + (i & 1)) & 7;
    const int y = (at[1] + ((i >> 1) & 1)) & 7;
    const int z = (at[2] + (i >> 2)) & 7;
    corners[static_cast<std::size_t>(i)] =
        blocks[static_cast<std::size_t>(i & crossing)][x | (y << 3) | (z << 6)];
  }
  return true;
}

std::size_t BlockGrid::memoryBytes() const {
  return regions_of_.size() * sizeof(std::int32_t) + regions_.size() * sizeof(Region) +
         blocks_.size() * (sizeof(VoxelBlock) + sizeof(Eigen::Vector3i)) +
         colors_.size() * sizeof(ColorBlock);
}

}  // namespace tarsus
