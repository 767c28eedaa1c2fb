#pragma once

#include "measurement/wound/reference_skin.h"
#include "reconstruction/scene/mesh.h"

#include <span>

namespace tarsus {

/// Triangulates the reference skin inside the outline for pictures and files (CGAL).
/// @param outline  the outline's feet on the skin, in order
[[nodiscard]] TriangleMesh meshSkin(const ReferenceSkin& skin,
                                    std::span<const Eigen::Vector2d> outline,
                                    double edge_mm);

}  // namespace tarsus
