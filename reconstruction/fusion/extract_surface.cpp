#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/block_surface.h"

#include <algorithm>

namespace tarsus {
namespace {

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
  const float least = leastWeight(min_weight);
  std::vector<BlockTriangles> triangles(static_cast<std::size_t>(grid.blockCount()));
  parallelFor(grid.blockCount(), [&](int block) {
    triangles[static_cast<std::size_t>(block)] = trianglesOfBlock(grid, block, least);
  });
  ExtractedSurface surface;
  VertexNumbers numbers(grid.blockCount());
  for (BlockTriangles& block : triangles) {
    for (std::size_t i = 0; i + 2 < block.edges.size(); i += 3) {
      const int a = numbers.numberOf(block.keyOf(block.edges[i]));
      const int b = numbers.numberOf(block.keyOf(block.edges[i + 1]));
      const int c = numbers.numberOf(block.keyOf(block.edges[i + 2]));
      surface.mesh.faces.emplace_back(a, b, c);
    }
    block.edges = {};
  }
  const std::vector<std::uint64_t>& keys = numbers.keys();
  surface.mesh.vertices.resize(keys.size());
  surface.mesh.normals.resize(keys.size());
  surface.sigma_mm.resize(keys.size());
  surface.observations.resize(keys.size());
  surface.colors.resize(grid.hasColor() ? keys.size() : 0);
  constexpr int kVerticesPerTask = 4096;
  const int count = static_cast<int>(keys.size());
  parallelFor((count + kVerticesPerTask - 1) / kVerticesPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kVerticesPerTask);
    for (int k = task * kVerticesPerTask; k < end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const SurfaceVertex vertex = vertexOnEdge(grid, keys[i]);
      surface.mesh.vertices[i] = vertex.position;
      surface.mesh.normals[i] = vertex.normal;
      surface.sigma_mm[i] = vertex.sigma_mm;
      surface.observations[i] = vertex.observations;
      if (grid.hasColor()) {
        surface.colors[i] = vertex.color;
      }
    }
  });
  return surface;
}

}  // namespace tarsus
