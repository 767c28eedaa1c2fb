#pragma once

#include "reconstruction/scene/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace tarsus {

/// Spreads known vertex values smoothly over the unknown ones along the mesh's edges.
/// @param known  #V, 1 where values[v] is given and stays
/// @param elsewhere  for vertices that no path joins to a known one
void diffuse(const TriangleMesh& mesh,
             std::span<const std::uint8_t> known,
             const Eigen::Vector3f& elsewhere,
             std::span<Eigen::Vector3f> values);

}  // namespace tarsus
