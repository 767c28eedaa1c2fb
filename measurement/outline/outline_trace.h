#pragma once

#include "measurement/outline/growing_patch.h"
#include "measurement/outline/outline.h"
#include "measurement/outline/surface_curve.h"

#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// Points on the straight line between their neighbours to within this add nothing to the curve
/// but the zigzag of snapping them to a rough surface. On a circle of 10 mm radius it keeps a point
/// each 0.9 mm, which takes 0.1 % from the area.
inline constexpr double kOutlineSimplify_mm = 0.01;

/// What is wrong with an outline, and where: for the place to be shown.
struct OutlineProblem {
  Error error;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
};

/// The shortest way from one bound point to another.
struct OutlinePiece {
  std::vector<SurfacePoint> way;          ///< from the first point on, without the second
  std::optional<OutlineProblem> problem;  ///< SurfaceIncomplete: over a hole, or no way at all
};

/// An outline and what is known of it at once. The hash and the clicks are left to the caller.
struct TracedOutline {
  WoundOutline outline;
  double area_mm2 = 0.0;  ///< of the surface inside, cut exactly
  double perimeter_mm = 0.0;
  std::vector<int> inside;  ///< the mesh's faces that lie wholly inside, ascending
};

/// Bound point as it is used: half a micrometre from an edge or vertex is on it.
[[nodiscard]] SurfaceNode clickNode(const SurfacePatch& patch, const SurfacePoint& point);

/// The patch, which must hold both points, grows until no way outside it could be shorter: the same
/// bits come out for every patch.
[[nodiscard]] OutlinePiece tracePiece(GrowingPatch& local,
                                      const SurfacePoint& from,
                                      const SurfacePoint& to);

/// Makes a simple closed curve of the pieces, each of which ends where the next begins, and turns
/// it so that the smaller side of the model lies left.
/// @return the outline, or OutlineInvalid, OutlineSelfIntersects, with its place
[[nodiscard]] tl::expected<TracedOutline, OutlineProblem> closePieces(
    GrowingPatch& local, std::span<const OutlinePiece* const> pieces);

/// Nodes of a chain of bound points on a patch that holds them.
[[nodiscard]] std::vector<SurfaceNode> nodesOf(const SurfacePatch& patch,
                                               std::span<const SurfacePoint> points);

/// "(1.00, 2.00, 3.00) mm"
[[nodiscard]] std::string placeText(const Eigen::Vector3d& p_mm);

}  // namespace tarsus
