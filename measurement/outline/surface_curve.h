#pragma once

#include "measurement/outline/surface_patch.h"
#include "reconstruction/base/error.h"

#include <utility>
#include <vector>

namespace tarsus {

/// Simple closed curve on a patch: node i is joined to node i + 1 inside one face, the last to the
/// first; no place is visited twice.
struct SurfaceCurve {
  std::vector<SurfaceNode> nodes;
};

/// Makes a simple closed curve of a chain of nodes. Spikes and loops of less than a millimetre,
/// which snapping to a rough surface leaves, are cut off; greater ones are refused.
/// @errors OutlineInvalid (fewer than 3 places, or neighbours that share no face),
///         OutlineSelfIntersects
[[nodiscard]] Expected<SurfaceCurve> closeCurve(const SurfacePatch& patch,
                                                std::vector<SurfaceNode> nodes);

[[nodiscard]] std::vector<Eigen::Vector3d> positionsOf(const SurfacePatch& patch,
                                                       const SurfaceCurve& curve);
[[nodiscard]] double lengthOf(const SurfacePatch& patch, const SurfaceCurve& curve);
[[nodiscard]] SurfaceCurve reversed(const SurfaceCurve& curve);

}  // namespace tarsus
