#pragma once

#include "reconstruction/scene/mesh.h"

#include <vector>

namespace tarsus {

/// Faces around each vertex: those of vertex v are faces[first[v]] to faces[first[v + 1]].
struct VertexFaces {
  explicit VertexFaces(const TriangleMesh& mesh);
  std::vector<int> first;  ///< #V + 1
  std::vector<int> faces;  ///< in ascending order for each vertex
};

/// Border of a mesh without repeated vertices, in the direction of its faces: they lie to the left,
/// the hole to the right.
struct BorderLoop {
  std::vector<int> vertices;
  std::vector<int> opposite;  ///< third vertex of the face at the edge from vertices[i]
};

/// All closed borders. Where borders touch in a vertex, each wedge of nothing belongs to one loop.
/// Borders that end at an edge of three or more faces are no loops and left out.
[[nodiscard]] std::vector<BorderLoop> borderLoops(const TriangleMesh& mesh);

/// Which connected piece (over shared vertices) each vertex belongs to, numbered from 0.
struct Pieces {
  std::vector<int> of_vertex;
  std::vector<double> area_mm2;  ///< of each piece
};
[[nodiscard]] Pieces connectedPieces(const TriangleMesh& mesh);

}  // namespace tarsus
