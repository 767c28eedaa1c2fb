#pragma once

#include "measurement/outline/surface_patch.h"

#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// Where a chain of nodes touches or crosses another, to within kCurveClearance of a face. Nodes
/// without a face (outside the patch) join nothing.
[[nodiscard]] std::optional<Eigen::Vector3d> contactOf(const SurfacePatch& patch,
                                                       std::span<const SurfaceNode> chain,
                                                       std::span<const SurfaceNode> other);

}  // namespace tarsus
