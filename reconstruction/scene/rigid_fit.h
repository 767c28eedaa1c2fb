#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh_index.h"

#include <span>

namespace tarsus {

/// Moves points onto a surface: trimmed point-to-plane ICP (Chen and Medioni 1992; Chetverikov et
/// al. 2002). For pairs that already lie within a few centimetres and some 20 degrees.
/// @param points_a   on the surface to be moved [mm]
/// @param b          what they are moved onto, with the index over it [mm]
/// @return           b_from_a; the identity where fewer than six points find a partner
[[nodiscard]] RigidTransform fitRigidly(std::span<const Eigen::Vector3d> points_a,
                                        const TriangleMesh& b,
                                        const MeshIndex& b_index);

}  // namespace tarsus
