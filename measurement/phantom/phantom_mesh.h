#pragma once

#include "measurement/phantom/phantom_design.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// Closed surface of a phantom, faces outward: every vertex of its top lies on the exact surface,
/// the rims of openings and floors are chains of edges. Wounds in steps of 0.5 mm, else 1.2 mm.
[[nodiscard]] TriangleMesh meshOf(const PhantomDesign& design);

}  // namespace tarsus
