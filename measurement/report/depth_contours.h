#pragma once

#include "reconstruction/scene/mesh.h"

#include <array>
#include <span>
#include <vector>

namespace tarsus {

/// Lines of equal depth across the triangles that face the viewer, as separate segments [mm].
/// @param depth_mm  one per vertex
/// @param step_mm   the first line lies at this depth
[[nodiscard]] std::vector<std::array<Eigen::Vector3d, 2>> depthContours(
    const TriangleMesh& mesh,
    std::span<const float> depth_mm,
    double step_mm,
    const Eigen::Vector3d& toward_viewer);

}  // namespace tarsus
