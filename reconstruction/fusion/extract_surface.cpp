#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/block_grid.h"
#include "reconstruction/fusion/marching_cubes_table.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr int kPadded = kBlockSide + 1;
constexpr std::uint64_t kEdgesPerBlock = 3ULL * kBlockVoxels;
/// Along an edge a distance changes by one edge length at the most; a cell that jumps further
/// joins the bands of two different surfaces. Ours: leaves room for noise.
constexpr float kMaxJump_voxels = 2.5F;
/// A vertex keeps off the grid points by this share of an edge, so that no triangle collapses.
constexpr float kVertexMargin = 1e-3F;
/// Poses and the sensor's own pattern err alike in neighbouring frames: more frames than this do
/// not make the mean better. Ours.
constexpr float kIndependentFrames = 25.0F;

float notObserved() { return std::numeric_limits<float>::quiet_NaN(); }

/// A block's distances with one more layer from its upper neighbours; NaN below the least weight.
struct PaddedBlock {
  std::array<int, 8> neighbours{};  ///< block numbers, by offset bits; -1 where there is none
  std::array<float, static_cast<std::size_t>(kPadded* kPadded* kPadded)> distance_mm{};

  [[nodiscard]] static std::size_t at(int x, int y, int z) {
    return static_cast<std::size_t>(x + kPadded * (y + kPadded * z));
  }
};

PaddedBlock padded(const BlockGrid& grid, int block, float min_weight) {
  PaddedBlock result;
  for (int n = 0; n < 8; ++n) {
    result.neighbours[static_cast<std::size_t>(n)] =
        grid.find(grid.coordinates(block) + Eigen::Vector3i(n & 1, (n >> 1) & 1, n >> 2));
  }
  for (int z = 0; z < kPadded; ++z) {
    for (int y = 0; y < kPadded; ++y) {
      for (int x = 0; x < kPadded; ++x) {
        const int n = (x >> 3) | ((y >> 3) << 1) | ((z >> 3) << 2);
        const int number = result.neighbours[static_cast<std::size_t>(n)];
        float& distance = result.distance_mm[PaddedBlock::at(x, y, z)];
        distance = notObserved();
        if (number >= 0) {
          const std::size_t voxel = BlockGrid::voxelInBlock({x, y, z});
          const VoxelBlock& source = grid.block(number);
          distance = source.weight[voxel] >= min_weight ? source.distance_mm[voxel] : distance;
        }
      }
    }
  }
  return result;
}

/// Sign pattern of a cell; 0 where it has no surface or must not be used.
int patternOf(const PaddedBlock& block, int x, int y, int z, float max_jump_mm) {
  std::array<float, 8> corners{};
  int pattern = 0;
  for (int i = 0; i < 8; ++i) {
    const float distance =
        block.distance_mm[PaddedBlock::at(x + (i & 1), y + ((i >> 1) & 1), z + (i >> 2))];
    if (std::isnan(distance)) {
      return 0;
    }
    corners[static_cast<std::size_t>(i)] = distance;
    pattern |= distance < 0.0F ? 1 << i : 0;
  }
  if (pattern == 0 || pattern == 255) {
    return 0;
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

/// A grid edge that the surface crosses, named by the block, voxel and axis it starts from.
std::uint64_t edgeKey(const PaddedBlock& block, int x, int y, int z, const CellEdge& edge) {
  const int ex = x + (edge.corner & 1);
  const int ey = y + ((edge.corner >> 1) & 1);
  const int ez = z + (edge.corner >> 2);
  const int n = (ex >> 3) | ((ey >> 3) << 1) | ((ez >> 3) << 2);
  const auto owner = static_cast<std::uint64_t>(block.neighbours[static_cast<std::size_t>(n)]);
  return owner * kEdgesPerBlock + 3ULL * BlockGrid::voxelInBlock({ex, ey, ez}) +
         static_cast<std::uint64_t>(edge.axis);
}

/// Triangles of one block, three edge keys each.
std::vector<std::uint64_t> trianglesOfBlock(const BlockGrid& grid, int number, float min_weight) {
  std::vector<std::uint64_t> keys;
  const PaddedBlock block = padded(grid, number, min_weight);
  const float max_jump_mm = kMaxJump_voxels * grid.voxelSize();
  for (int cell = 0; cell < kBlockVoxels; ++cell) {
    const int x = cell & 7;
    const int y = (cell >> 3) & 7;
    const int z = cell >> 6;
    const int pattern = patternOf(block, x, y, z, max_jump_mm);
    const CellTriangles& triangles = marchingCubesTable()[static_cast<std::size_t>(pattern)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(3 * triangles.count); ++i) {
      const auto edge = static_cast<std::size_t>(triangles.edges[i]);
      keys.push_back(edgeKey(block, x, y, z, kCellEdges[edge]));
    }
  }
  return keys;
}

/// Turns edge keys into vertices with all they carry.
class VertexMaker {
 public:
  VertexMaker(const BlockGrid& grid, ExtractedSurface& surface) : grid_(grid), surface_(surface) {}

  void make(std::size_t vertex, std::uint64_t key) const {
    const auto number = static_cast<int>(key / kEdgesPerBlock);
    const auto in_block = static_cast<int>(key % kEdgesPerBlock);
    const int axis = in_block % 3;
    const int v = in_block / 3;
    const Eigen::Vector3i a =
        grid_.coordinates(number) * kBlockSide + Eigen::Vector3i(v & 7, (v >> 3) & 7, v >> 6);
    const Eigen::Vector3i b = a + Eigen::Vector3i::Unit(axis);
    const float da = grid_.distanceAt(a);
    const float db = grid_.distanceAt(b);
    const float t = std::clamp(da / (da - db), kVertexMargin, 1.0F - kVertexMargin);
    const auto voxel_a = static_cast<std::size_t>(v);
    const std::size_t voxel_b = BlockGrid::voxelInBlock(b);
    const int number_b = grid_.find({b.x() >> 3, b.y() >> 3, b.z() >> 3});
    const VoxelBlock& block_a = grid_.block(number);
    const VoxelBlock& block_b = grid_.block(number_b);
    surface_.mesh.vertices[vertex] =
        (a.cast<float>() + t * Eigen::Vector3f::Unit(axis)) * grid_.voxelSize();
    surface_.mesh.normals[vertex] = ((1.0F - t) * gradientAt(a) + t * gradientAt(b)).normalized();
    surface_.sigma_mm[vertex] =
        (1.0F - t) * sigmaOf(block_a, voxel_a) + t * sigmaOf(block_b, voxel_b);
    surface_.observations[vertex] =
        std::min(block_a.observations[voxel_a], block_b.observations[voxel_b]);
    if (grid_.hasColor()) {
      const ColorBlock& colors_a = grid_.colors(number);
      const ColorBlock& colors_b = grid_.colors(number_b);
      const float share_a = colors_a.weight[voxel_a] > 0.0F ? 1.0F - t : 0.0F;
      const float share_b = colors_b.weight[voxel_b] > 0.0F ? t : 0.0F;
      surface_.colors[vertex] = mix(colors_a.rgb[voxel_a], share_a, colors_b.rgb[voxel_b], share_b);
    }
  }

 private:
  /// Slope along one axis from what was observed; the vertex's own edge always is.
  [[nodiscard]] float slope(const Eigen::Vector3i& voxel, float middle, int axis) const {
    const float above = grid_.distanceAt(voxel + Eigen::Vector3i::Unit(axis));
    const float below = grid_.distanceAt(voxel - Eigen::Vector3i::Unit(axis));
    if (std::isnan(above)) {
      return std::isnan(below) ? 0.0F : middle - below;
    }
    return std::isnan(below) ? above - middle : 0.5F * (above - below);
  }
  [[nodiscard]] Eigen::Vector3f gradientAt(const Eigen::Vector3i& voxel) const {
    const float middle = grid_.distanceAt(voxel);
    return {slope(voxel, middle, 0), slope(voxel, middle, 1), slope(voxel, middle, 2)};
  }
  /// Standard error of the voxel's mean distance.
  [[nodiscard]] static float sigmaOf(const VoxelBlock& block, std::size_t voxel) {
    const float weight = block.weight[voxel];
    const float variance = std::max(0.0F, block.deviation_mm2[voxel]) / weight;
    const auto frames = static_cast<float>(block.observations[voxel]);
    return std::sqrt(variance / std::clamp(frames - 1.0F, 1.0F, kIndependentFrames));
  }
  [[nodiscard]] static Rgb8 mix(const std::array<float, 3>& a,
                                float share_a,
                                const std::array<float, 3>& b,
                                float share_b) {
    const float sum = share_a + share_b;
    const auto channel = [&](std::size_t i) {
      const float value = sum > 0.0F ? (a[i] * share_a + b[i] * share_b) / sum : 127.0F;
      return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    };
    return {channel(0), channel(1), channel(2)};
  }

  const BlockGrid& grid_;
  ExtractedSurface& surface_;
};

/// Numbers edges in the order in which the triangles name them first.
class VertexNumbers {
 public:
  explicit VertexNumbers(int blocks) : numbers_(static_cast<std::size_t>(blocks)) {}

  int numberOf(std::uint64_t key) {
    std::vector<std::int32_t>& block = numbers_[key / kEdgesPerBlock];
    if (block.empty()) {
      block.assign(kEdgesPerBlock, -1);
    }
    std::int32_t& number = block[key % kEdgesPerBlock];
    if (number < 0) {
      number = static_cast<std::int32_t>(keys_.size());
      keys_.push_back(key);
    }
    return number;
  }
  [[nodiscard]] const std::vector<std::uint64_t>& keys() const { return keys_; }

 private:
  std::vector<std::vector<std::int32_t>> numbers_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace

ExtractedSurface extractFromGrid(const BlockGrid& grid, float min_weight) {
  // A voxel without weight has no distance: "at least 0" still means observed.
  const float least = std::max(min_weight, std::numeric_limits<float>::min());
  std::vector<std::vector<std::uint64_t>> triangles(static_cast<std::size_t>(grid.blockCount()));
  parallelFor(grid.blockCount(), [&](int block) {
    triangles[static_cast<std::size_t>(block)] = trianglesOfBlock(grid, block, least);
  });
  ExtractedSurface surface;
  VertexNumbers numbers(grid.blockCount());
  for (std::vector<std::uint64_t>& keys : triangles) {
    for (std::size_t i = 0; i + 2 < keys.size(); i += 3) {
      const int a = numbers.numberOf(keys[i]);
      const int b = numbers.numberOf(keys[i + 1]);
      const int c = numbers.numberOf(keys[i + 2]);
      surface.mesh.faces.emplace_back(a, b, c);
    }
    keys = {};
  }
  const std::vector<std::uint64_t>& keys = numbers.keys();
  surface.mesh.vertices.resize(keys.size());
  surface.mesh.normals.resize(keys.size());
  surface.sigma_mm.resize(keys.size());
  surface.observations.resize(keys.size());
  surface.colors.resize(grid.hasColor() ? keys.size() : 0);
  const VertexMaker maker(grid, surface);
  constexpr int kVerticesPerTask = 4096;
  const int count = static_cast<int>(keys.size());
  parallelFor((count + kVerticesPerTask - 1) / kVerticesPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kVerticesPerTask);
    for (int i = task * kVerticesPerTask; i < end; ++i) {
      maker.make(static_cast<std::size_t>(i), keys[static_cast<std::size_t>(i)]);
    }
  });
  return surface;
}

}  // namespace tarsus
