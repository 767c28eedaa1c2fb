#pragma once

#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// Takes back what `subdivide` did: from the last vertex on, each that lies in the middle between
/// two neighbours, as splitting their edge would have made it, goes. The shape stays the same.
/// @return the coarser mesh and which vertices it kept
[[nodiscard]] CompactedMesh undoSubdivision(const TriangleMesh& mesh);

}  // namespace tarsus
