#pragma once

#include "reconstruction/scene/mesh.h"

#include <array>
#include <vector>

namespace tarsus {

/// For each face and its edges (0,1), (1,2), (2,0): the face beyond, -1 where there is none. Where
/// more than two faces meet in an edge, they pair up in the order of their numbers.
using FaceNeighbors = std::vector<std::array<int, 3>>;

[[nodiscard]] FaceNeighbors faceNeighbors(const TriangleMesh& mesh);

}  // namespace tarsus
