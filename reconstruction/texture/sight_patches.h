#pragma once

#include "reconstruction/texture/color_alignment.h"
#include "reconstruction/texture/lanes.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tarsus {

/// Eight lines of sight of one picture; those that fill up the last block weigh nothing.
struct alignas(32) SightBlock {
  std::array<float, kLanes> weight{};
  std::array<std::int32_t, kLanes> vertex{};  ///< in the patch
};

/// Blocks of one picture, during bending of one cell of its lattice.
struct SightRun {
  std::uint32_t picture = 0;
  std::uint32_t cell = 0;  ///< its upper left node
  std::uint32_t first_block = 0;
  std::uint32_t blocks = 0;
};

/// Vertices that lie together with all pictures that see them: they need the same small parts of
/// the images, and nothing of other patches.
struct SightPatch {
  std::vector<float> x_mm, y_mm, z_mm;  ///< scan frame
  std::vector<SightRun> runs;           ///< ascending pictures and cells
  std::vector<SightBlock> blocks;
};

/// Vertices ordered along a Morton curve, so that neighbours in the order are neighbours in space.
[[nodiscard]] std::vector<std::uint32_t> mortonOrder(std::span<const Eigen::Vector3f> vertices);

/// Which lines of sight to take into patches.
struct PatchChoice {
  std::size_t thinning = 1;  ///< every so manieth vertex along the order
  float least_trust = 0.0F;
  /// The lattice cell of a picture that a place falls on; null: all one cell.
  std::function<std::uint32_t(std::size_t picture, const Eigen::Vector3f& p_scan)> cell_of;
};

[[nodiscard]] std::vector<SightPatch> makeSightPatches(std::span<const Eigen::Vector3f> vertices,
                                                       std::span<const std::uint32_t> order,
                                                       std::span<const AlignedPicture> pictures,
                                                       const PatchChoice& choice);

}  // namespace tarsus
