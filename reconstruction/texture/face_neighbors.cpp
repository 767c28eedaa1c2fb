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

}  // namespace tarsus
