#include "reconstruction/fusion/preview_mesh.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/block_surface.h"

#include <algorithm>

namespace tarsus {
namespace {

constexpr int kBlocksPerTask = 16;

/// These blocks and all that touch them, each once, by number: triangles read the upper
/// neighbours, normals the lower ones too.
std::vector<int> withNeighbours(const BlockGrid& grid, const std::vector<int>& changed) {
  std::vector<char> wanted(static_cast<std::size_t>(grid.blockCount()), 0);
  for (const int block : changed) {
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i offset(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const int neighbour = grid.find(grid.coordinates(block) + offset);
      if (neighbour >= 0) {
        wanted[static_cast<std::size_t>(neighbour)] = 1;
      }
    }
  }
  std::vector<int> result;
  for (int i = 0; i < grid.blockCount(); ++i) {
    if (wanted[static_cast<std::size_t>(i)] != 0) {
      result.push_back(i);
    }
  }
  return result;
}

/// Numbers the edges of a block's triangles in the order in which they are named first.
std::vector<std::uint16_t> numberEdges(const BlockTriangles& triangles, PreviewPiece& piece) {
  std::vector<std::uint16_t> edges;
  std::array<std::int16_t, kLocalEdges> number_of_edge;
  number_of_edge.fill(-1);
  const auto numberOf = [&](std::uint16_t edge) {
    std::int16_t& number = number_of_edge[edge];
    if (number < 0) {
      number = static_cast<std::int16_t>(edges.size());
      edges.push_back(edge);
    }
    return static_cast<int>(number);
  };
  piece.mesh.faces.reserve(triangles.edges.size() / 3);
  for (std::size_t i = 0; i + 2 < triangles.edges.size(); i += 3) {
    const int a = numberOf(triangles.edges[i]);
    const int b = numberOf(triangles.edges[i + 1]);
    const int c = numberOf(triangles.edges[i + 2]);
    piece.mesh.faces.emplace_back(a, b, c);
  }
  return edges;
}

std::shared_ptr<const PreviewPiece> meshBlock(const BlockGrid& grid,
                                              int block,
                                              float least_weight,
                                              int version) {
  const BlockTriangles triangles = trianglesOfBlock(grid, block, least_weight);
  if (triangles.edges.empty()) {
    return nullptr;
  }
  auto piece = std::make_shared<PreviewPiece>();
  piece->block = block;
  piece->version = version;
  const std::vector<std::uint16_t> edges = numberEdges(triangles, *piece);
  piece->mesh.vertices.reserve(edges.size());
  piece->mesh.normals.reserve(edges.size());
  piece->weight.reserve(edges.size());
  piece->observations.reserve(edges.size());
  for (const std::uint16_t edge : edges) {
    const SurfaceVertex vertex = vertexOnEdge(grid, triangles.keyOf(edge));
    piece->mesh.vertices.push_back(vertex.position);
    piece->mesh.normals.push_back(vertex.normal);
    piece->weight.push_back(vertex.weight);
    piece->observations.push_back(vertex.observations);
  }
  return piece;
}

}  // namespace

int PreviewMesh::update(const TsdfVolume& volume, int most_blocks) {
  const BlockGrid& grid = volume.blocks();
  if (queue_.empty() && frames_seen_ < volume.framesFused()) {
    const std::vector<int> dirty = withNeighbours(grid, volume.blocksChangedSince(frames_seen_));
    queue_.assign(dirty.begin(), dirty.end());
    frames_seen_ = volume.framesFused();
    pieces_.resize(static_cast<std::size_t>(grid.blockCount()));
  }
  const int count = std::min(most_blocks, pending());
  const float least = leastWeight(min_weight_);
  parallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      const int block = queue_[static_cast<std::size_t>(i)];
      pieces_[static_cast<std::size_t>(block)] =
          meshBlock(grid, block, least, volume.framesFused());
    }
  });
  queue_.erase(queue_.begin(), queue_.begin() + count);
  return count;
}

PreviewSurface joinPieces(const PreviewPieces& pieces) {
  PreviewSurface all;
  for (const auto& piece : pieces) {
    if (!piece) {
      continue;
    }
    const auto first = static_cast<int>(all.mesh.vertices.size());
    const TriangleMesh& mesh = piece->mesh;
    all.mesh.vertices.insert(all.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    all.mesh.normals.insert(all.mesh.normals.end(), mesh.normals.begin(), mesh.normals.end());
    all.weight.insert(all.weight.end(), piece->weight.begin(), piece->weight.end());
    all.observations.insert(
        all.observations.end(), piece->observations.begin(), piece->observations.end());
    for (const Eigen::Vector3i& face : mesh.faces) {
      all.mesh.faces.emplace_back(face.array() + first);
    }
  }
  return all;
}

}  // namespace tarsus
