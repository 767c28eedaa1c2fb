#pragma once

#include "reconstruction/scene/mesh.h"

#include <array>
#include <vector>

namespace tarsus {

/// For each face and its edges (0,1), (1,2), (2,0): the face beyond, -1 where there is none. Where
/// more than two faces meet in an edge, they pair up in the order of their numbers.
using FaceNeighbors = std::vector<std::array<int, 3>>;

[[nodiscard]] FaceNeighbors faceNeighbors(const TriangleMesh& mesh);

/// Numbers of the connected sets of faces of one label, counted in the order of their lowest face.
struct FacePatches {
  std::vector<int> patch_of;              ///< #F
  std::vector<std::vector<int>> patches;  ///< faces of each, ascending
};
[[nodiscard]] FacePatches connectedPatches(const FaceNeighbors& neighbors,
                                           const std::vector<int>& labels);

}  // namespace tarsus
