#include "reconstruction/texture/face_neighbors.h"

#include <algorithm>
#include <tuple>

namespace tarsus {
namespace {

struct FaceEdge {
  int low = 0;  // vertices
  int high = 0;
  int face = 0;
  int edge = 0;
};

}  // namespace

FaceNeighbors faceNeighbors(const TriangleMesh& mesh) {
  std::vector<FaceEdge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.faces[f][k];
      const int b = mesh.faces[f][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f), k});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const FaceEdge& a, const FaceEdge& b) {
    return std::tie(a.low, a.high, a.face, a.edge) < std::tie(b.low, b.high, b.face, b.edge);
  });
  FaceNeighbors neighbors(mesh.faces.size(), {-1, -1, -1});
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const FaceEdge& a = edges[i];
    const FaceEdge& b = edges[i + 1];
    if (a.low == b.low && a.high == b.high) {
      neighbors[static_cast<std::size_t>(a.face)][static_cast<std::size_t>(a.edge)] = b.face;
      neighbors[static_cast<std::size_t>(b.face)][static_cast<std::size_t>(b.edge)] = a.face;
      ++i;
    }
  }
  return neighbors;
}

FacePatches connectedPatches(const FaceNeighbors& neighbors, const std::vector<int>& labels) {
  FacePatches result;
  result.patch_of.assign(labels.size(), -1);
  for (std::size_t seed = 0; seed < labels.size(); ++seed) {
    if (result.patch_of[seed] >= 0) {
      continue;
    }
    const int number = static_cast<int>(result.patches.size());
    std::vector<int> patch{static_cast<int>(seed)};
    result.patch_of[seed] = number;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (const int beyond : neighbors[static_cast<std::size_t>(patch[i])]) {
        const auto f = static_cast<std::size_t>(beyond);
        if (beyond >= 0 && result.patch_of[f] < 0 && labels[f] == labels[seed]) {
          result.patch_of[f] = number;
          patch.push_back(beyond);
        }
      }
    }
    std::sort(patch.begin(), patch.end());
    result.patches.push_back(std::move(patch));
  }
  return result;
}

}  // namespace tarsus
