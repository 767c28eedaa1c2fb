#pragma once

#include "measurement/outline/surface_patch.h"
#include "reconstruction/base/error.h"

#include <utility>
#include <vector>

namespace tarsus {

/// Simple closed curve on a patch: node i is joined to node i + 1 inside one face, the last to the
/// first; no place is visited twice. In each face, in barycentric units, nodes keep kSnapFraction
/// from each other and kCurveClearance from segments that they do not end, so that cutting along
/// the curve leaves no sliver.
struct SurfaceCurve {
  std::vector<SurfaceNode> nodes;
};
inline constexpr double kCurveClearance = 0.5 * kSnapFraction;

/// Why a chain of nodes is no simple curve, and where.
struct CurveFault {
  Error error;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
};

enum class CurveEnds { Joined, Open };

/// Makes a simple curve of a chain of nodes. Spikes and loops of less than a millimetre, which
/// snapping to a rough surface leaves, are cut off; greater ones are refused. Open curves are only
/// judged: their ends are not joined, and a single node will do.
/// @errors OutlineInvalid (fewer than 3 places, or neighbours that share no face),
///         OutlineSelfIntersects
[[nodiscard]] tl::expected<SurfaceCurve, CurveFault> simpleCurve(const SurfacePatch& patch,
                                                                 std::vector<SurfaceNode> nodes,
                                                                 CurveEnds ends);
/// The same, closed, without the place.
[[nodiscard]] Expected<SurfaceCurve> closeCurve(const SurfacePatch& patch,
                                                std::vector<SurfaceNode> nodes);

[[nodiscard]] std::vector<Eigen::Vector3d> positionsOf(const SurfacePatch& patch,
                                                       const SurfaceCurve& curve);
[[nodiscard]] double lengthOf(const SurfacePatch& patch, const SurfaceCurve& curve);
[[nodiscard]] SurfaceCurve reversed(const SurfaceCurve& curve);

}  // namespace tarsus
