#pragma once

#include "reconstruction/fusion/block_grid.h"

namespace tarsus {

/// Edges of the cells that start in one block: 9^3 places, three axes. Private to fusion/.
inline constexpr int kPaddedSide = kBlockSide + 1;
inline constexpr std::size_t kLocalEdges =
    3U * static_cast<std::size_t>(kPaddedSide * kPaddedSide * kPaddedSide);
/// Edges that a block owns: those that start at one of its own voxels.
inline constexpr std::uint64_t kEdgesPerBlock = 3ULL * kBlockVoxels;

/// Marching cubes over the cells that start in one block; they reach one voxel into the blocks on
/// its upper sides. Private to fusion/.
struct BlockTriangles {
  std::array<int, 8> neighbours{};   ///< block numbers by offset bits, [0] itself; -1: none
  std::vector<std::uint16_t> edges;  ///< three a triangle, each below kLocalEdges

  /// The edge's name in the whole grid: owning block * kEdgesPerBlock + 3 * voxel + axis.
  [[nodiscard]] std::uint64_t keyOf(std::uint16_t edge) const;
};

/// A vertex on an edge that the surface crosses, with all it carries.
struct SurfaceVertex {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< scan frame [mm]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, from the field's gradient
  float sigma_mm = 0.0F;
  float weight = 0.0F;             ///< the lesser of the edge's two voxels
  std::uint16_t observations = 0;  ///< the same
  Rgb8 color;                      ///< grey without colour
};

/// The least weight that counts as observed at all, where less is asked for.
[[nodiscard]] float leastWeight(float min_weight);

/// @param least_weight  from leastWeight()
[[nodiscard]] BlockTriangles trianglesOfBlock(const BlockGrid& grid, int block, float least_weight);

/// @param key  of an edge of one of the triangles. Reads the blocks all round for the gradient.
[[nodiscard]] SurfaceVertex vertexOnEdge(const BlockGrid& grid, std::uint64_t key);

}  // namespace tarsus
