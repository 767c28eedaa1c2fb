#pragma once

#include "reconstruction/scene/mesh.h"
#include "reconstruction/scene/mesh_index.h"

#include <span>
#include <vector>

namespace tarsus {

/// Carries the points of a closed outline that lie off the surface onto it along the normal of the
/// skin beside them, on the side away from the outline's middle. A fused model rounds the rim of a
/// wound; there the nearest point lies outward as well as below, and every area came out 1 to 3 %
/// too large. Points on the surface, and those whose normal misses it, stay where they are nearest.
/// @param points_mm  scan frame
/// @param nearest    of each point; changed in place
void carryAlongSkin(const TriangleMesh& mesh,
                    const MeshIndex& index,
                    std::span<const Eigen::Vector3d> points_mm,
                    std::span<MeshIndex::NearestPoint> nearest);

}  // namespace tarsus
