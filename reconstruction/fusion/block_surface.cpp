#include "reconstruction/fusion/block_surface.h"

#include "reconstruction/base/vector_code.h"
#include "reconstruction/fusion/marching_cubes_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace tarsus {
namespace {

/// Along an edge a distance changes by one edge length at the most; a cell that jumps further
/// joins the bands of two different surfaces. Ours: leaves room for noise.
constexpr float kMaxJump_voxels = 2.5F;
/// A vertex keeps off the grid points by this share of an edge, so that no triangle collapses.
constexpr float kVertexMargin = 1e-3F;
/// Poses and the sensor's own pattern err alike in neighbouring frames: more frames than this do
/// not make the mean better. Ours.
constexpr float kIndependentFrames = 25.0F;

constexpr std::uint64_t kLowBits = 0x0101010101010101ULL;

/// For each voxel 0 where it may not be used, else 1 before and 3 behind the surface.
using VoxelSides = std::array<std::uint8_t, kBlockVoxels>;

TARSUS_VECTOR_CODE void findSides(const VoxelBlock& block, float least_weight, VoxelSides& sides) {
  for (std::size_t i = 0; i < kBlockVoxels; ++i) {
    const float distance = block.distance_mm[i];
    const bool known = (block.weight[i] >= least_weight) & (distance == distance);
    sides[i] = static_cast<std::uint8_t>(known ? (distance < 0.0F ? 3 : 1) : 0);
  }
}

/// The lowest bit of each of 8 bytes, the first byte's first.
std::uint32_t gatherLowBits(std::uint64_t bytes) {
  return static_cast<std::uint32_t>(((bytes & kLowBits) * 0x0102040810204080ULL) >> 56U);
}

/// A block's voxels with one more layer from its upper neighbours: one bit a voxel and one entry a
/// row (y, z) tell what may be used and what lies behind the surface.
class PaddedBlock {
 public:
  PaddedBlock(const BlockGrid& grid, const std::array<int, 8>& blocks, float least_weight) {
    for (std::size_t n = 0; n < blocks.size(); ++n) {
      blocks_[n] = blocks[n] < 0 ? nullptr : &grid.block(blocks[n]);
    }
    takeOwn(least_weight);
    if (any_known_) {
      takeBorder(least_weight);
    }
  }

  [[nodiscard]] static std::size_t at(int x, int y, int z) {
    return static_cast<std::size_t>(x) + kPaddedSide * row(y, z);
  }
  /// Each cell starts at a voxel of the block itself.
  [[nodiscard]] bool mayHaveCells() const { return any_known_; }
  [[nodiscard]] float distance(int x, int y, int z) const {
    return blockAt(x, y, z)->distance_mm[BlockGrid::voxelInBlock({x, y, z})];
  }
  /// One bit for each cell of the row that has all 8 corners and both signs.
  [[nodiscard]] std::uint32_t cellsInRow(int y, int z) const {
    const std::array<std::size_t, 4> rows{
        row(y, z), row(y + 1, z), row(y, z + 1), row(y + 1, z + 1)};
    std::uint32_t all_known = (1U << kPaddedSide) - 1U;
    std::uint32_t any_behind = 0;
    std::uint32_t all_behind = all_known;
    for (const std::size_t r : rows) {
      all_known &= known_[r];
      any_behind |= behind_[r];
      all_behind &= behind_[r];
    }
    all_known &= all_known >> 1U;
    any_behind |= any_behind >> 1U;
    all_behind &= all_behind >> 1U;
    return all_known & any_behind & ~all_behind & ((1U << kBlockSide) - 1U);
  }

 private:
  [[nodiscard]] static std::size_t row(int y, int z) {
    return static_cast<std::size_t>(y + kPaddedSide * z);
  }
  [[nodiscard]] const VoxelBlock* blockAt(int x, int y, int z) const {
    return blocks_[static_cast<std::size_t>((x >> 3) | ((y >> 3) << 1) | ((z >> 3) << 2))];
  }
  void takeOwn(float least_weight) {
    VoxelSides sides;
    findSides(*blocks_[0], least_weight, sides);
    for (int r = 0; r < kBlockSide * kBlockSide; ++r) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, sides.data() + r * kBlockSide, sizeof bytes);
      known_[row(r & 7, r >> 3)] = gatherLowBits(bytes);
      behind_[row(r & 7, r >> 3)] = gatherLowBits(bytes >> 1U);
      any_known_ = any_known_ || bytes != 0;
    }
  }
  void takeBorder(float least_weight) {
    for (int z = 0; z < kPaddedSide; ++z) {
      for (int y = 0; y < kPaddedSide; ++y) {
        const bool own_row = y < kBlockSide && z < kBlockSide;
        for (int x = own_row ? kBlockSide : 0; x < kPaddedSide; ++x) {
          take(x, y, z, least_weight);
        }
      }
    }
  }
  void take(int x, int y, int z, float least_weight) {
    const VoxelBlock* const block = blockAt(x, y, z);
    const std::size_t voxel = BlockGrid::voxelInBlock({x, y, z});
    if (block == nullptr || !(block->weight[voxel] >= least_weight)) {
      return;
    }
    const float distance = block->distance_mm[voxel];
    known_[row(y, z)] |= static_cast<std::uint32_t>(!std::isnan(distance)) << x;
    behind_[row(y, z)] |= static_cast<std::uint32_t>(distance < 0.0F) << x;
  }

  static constexpr std::size_t kRows = static_cast<std::size_t>(kPaddedSide * kPaddedSide);
  std::array<const VoxelBlock*, 8> blocks_{};  ///< by offset bits, [0] itself
  std::array<std::uint32_t, kRows> known_{};
  std::array<std::uint32_t, kRows> behind_{};
  bool any_known_ = false;
};

/// Sign pattern of a cell with known corners; 0 where it must not be used.
int patternOf(const PaddedBlock& block, int x, int y, int z, float max_jump_mm) {
  std::array<float, 8> corners{};
  int pattern = 0;
  for (int i = 0; i < 8; ++i) {
    const float distance = block.distance(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2));
    corners[static_cast<std::size_t>(i)] = distance;
    pattern |= distance < 0.0F ? 1 << i : 0;
  }
  for (const CellEdge& edge : kCellEdges) {
    const float a = corners[static_cast<std::size_t>(edge.corner)];
    const float b = corners[static_cast<std::size_t>(edge.corner | (1 << edge.axis))];
    if ((a < 0.0F) != (b < 0.0F) && std::abs(a - b) > max_jump_mm) {
      return 0;
    }
  }
  return pattern;
}

std::uint16_t localEdge(int x, int y, int z, const CellEdge& edge) {
  const std::size_t start =
      PaddedBlock::at(x + (edge.corner & 1), y + ((edge.corner >> 1) & 1), z + (edge.corner >> 2));
  return static_cast<std::uint16_t>(3U * start + static_cast<std::size_t>(edge.axis));
}

/// Slope along one axis from what was observed; the vertex's own edge always is.
float slope(const BlockGrid& grid, const Eigen::Vector3i& voxel, float middle, int axis) {
  const float above = grid.distanceAt(voxel + Eigen::Vector3i::Unit(axis));
  const float below = grid.distanceAt(voxel - Eigen::Vector3i::Unit(axis));
  if (std::isnan(above)) {
    return std::isnan(below) ? 0.0F : middle - below;
  }
  return std::isnan(below) ? above - middle : 0.5F * (above - below);
}

/// One voxel at the end of an edge.
struct EdgeEnd {
  int number;  ///< of its block
  std::size_t voxel;
  Eigen::Vector3i at;
};

Eigen::Vector3f gradientAt(const BlockGrid& grid, const EdgeEnd& end) {
  const VoxelBlock& block = grid.block(end.number);
  const std::size_t i = end.voxel;
  const float middle = block.distance_mm[i];
  const Eigen::Vector3i in_block(end.at.x() & 7, end.at.y() & 7, end.at.z() & 7);
  Eigen::Vector3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t step = std::size_t{1} << (3 * axis);
    const bool inside = in_block[axis] > 0 && in_block[axis] < kBlockSide - 1;
    const float twice =
        inside ? block.distance_mm[i + step] - block.distance_mm[i - step] : std::nanf("");
    // NaN where the block ends or a neighbour was not observed: the careful way.
    gradient[axis] = std::isnan(twice) ? slope(grid, end.at, middle, axis) : 0.5F * twice;
  }
  return gradient;
}

/// Standard error of the voxel's mean distance.
float sigmaOf(const VoxelBlock& block, std::size_t voxel) {
  const float weight = block.weight[voxel];
  const float variance = std::max(0.0F, block.deviation_mm2[voxel]) / weight;
  const auto frames = static_cast<float>(block.observations[voxel]);
  return std::sqrt(variance / std::clamp(frames - 1.0F, 1.0F, kIndependentFrames));
}

Rgb8 mix(const ColorBlock& block_a, std::size_t a, const ColorBlock& block_b, EdgeEnd b, float t) {
  const float share_a = block_a.weight[a] > 0.0F ? 1.0F - t : 0.0F;
  const float share_b = block_b.weight[b.voxel] > 0.0F ? t : 0.0F;
  const float sum = share_a + share_b;
  const auto channel = [&](std::size_t i) {
    const float value =
        sum > 0.0F ? (block_a.rgb[a][i] * share_a + block_b.rgb[b.voxel][i] * share_b) / sum
                   : 127.0F;
    return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

std::uint64_t BlockTriangles::keyOf(std::uint16_t edge) const {
  const int start = edge / 3;
  const int x = start % kPaddedSide;
  const int y = start / kPaddedSide % kPaddedSide;
  const int z = start / (kPaddedSide * kPaddedSide);
  const int n = (x >> 3) | ((y >> 3) << 1) | ((z >> 3) << 2);
  const auto owner = static_cast<std::uint64_t>(neighbours[static_cast<std::size_t>(n)]);
  return owner * kEdgesPerBlock + 3ULL * BlockGrid::voxelInBlock({x, y, z}) + edge % 3U;
}

float leastWeight(float min_weight) {
  // A voxel without weight has no distance: "at least 0" still means observed.
  return std::max(min_weight, std::numeric_limits<float>::min());
}

BlockTriangles trianglesOfBlock(const BlockGrid& grid, int number, float least_weight) {
  BlockTriangles result;
  for (int n = 0; n < 8; ++n) {
    result.neighbours[static_cast<std::size_t>(n)] =
        grid.find(grid.coordinates(number) + Eigen::Vector3i(n & 1, (n >> 1) & 1, n >> 2));
  }
  const PaddedBlock block(grid, result.neighbours, least_weight);
  if (!block.mayHaveCells()) {
    return result;
  }
  const float max_jump_mm = kMaxJump_voxels * grid.voxelSize();
  for (int row = 0; row < kBlockSide * kBlockSide; ++row) {
    const int y = row & 7;
    const int z = row >> 3;
    for (std::uint32_t cells = block.cellsInRow(y, z); cells != 0; cells &= cells - 1U) {
      const int x = std::countr_zero(cells);
      const int pattern = patternOf(block, x, y, z, max_jump_mm);
      const CellTriangles& triangles = marchingCubesTable()[static_cast<std::size_t>(pattern)];
      for (std::size_t i = 0; i < static_cast<std::size_t>(3 * triangles.count); ++i) {
        const auto edge = static_cast<std::size_t>(triangles.edges[i]);
        result.edges.push_back(localEdge(x, y, z, kCellEdges[edge]));
      }
    }
  }
  return result;
}

SurfaceVertex vertexOnEdge(const BlockGrid& grid, std::uint64_t key) {
  const auto number = static_cast<int>(key / kEdgesPerBlock);
  const auto in_block = static_cast<int>(key % kEdgesPerBlock);
  const int axis = in_block % 3;
  const int v = in_block / 3;
  const EdgeEnd a{
      .number = number,
      .voxel = static_cast<std::size_t>(v),
      .at = grid.coordinates(number) * kBlockSide + Eigen::Vector3i(v & 7, (v >> 3) & 7, v >> 6)};
  const Eigen::Vector3i at_b = a.at + Eigen::Vector3i::Unit(axis);
  const EdgeEnd b{.number = grid.find({at_b.x() >> 3, at_b.y() >> 3, at_b.z() >> 3}),
                  .voxel = BlockGrid::voxelInBlock(at_b),
                  .at = at_b};
  const VoxelBlock& block_a = grid.block(a.number);
  const VoxelBlock& block_b = grid.block(b.number);
  const float da = block_a.distance_mm[a.voxel];
  const float db = block_b.distance_mm[b.voxel];
  const float t = std::clamp(da / (da - db), kVertexMargin, 1.0F - kVertexMargin);
  SurfaceVertex vertex;
  vertex.position = (a.at.cast<float>() + t * Eigen::Vector3f::Unit(axis)) * grid.voxelSize();
  vertex.normal = ((1.0F - t) * gradientAt(grid, a) + t * gradientAt(grid, b)).normalized();
  vertex.sigma_mm = (1.0F - t) * sigmaOf(block_a, a.voxel) + t * sigmaOf(block_b, b.voxel);
  vertex.weight = std::min(block_a.weight[a.voxel], block_b.weight[b.voxel]);
  vertex.observations = std::min(block_a.observations[a.voxel], block_b.observations[b.voxel]);
  if (grid.hasColor()) {
    vertex.color = mix(grid.colors(a.number), a.voxel, grid.colors(b.number), b, t);
  }
  return vertex;
}

}  // namespace tarsus
