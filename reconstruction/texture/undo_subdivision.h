#pragma once

#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// Takes back what `subdivide` did: from the last vertex on, each that lies in the middle between
/// two neighbours, as splitting their edge would have made it, goes. The shape stays the same.
/// @param max_edge_mm  no edge is made longer, so that views are told apart on flat parts too
/// @return the coarser mesh and which vertices it kept
[[nodiscard]] CompactedMesh undoSubdivision(const TriangleMesh& mesh, double max_edge_mm = 5.0);

}  // namespace tarsus
