#pragma once

#include "measurement/outline/surface_patch.h"

#include <optional>
#include <vector>

namespace tarsus {

/// Way over a surface; consecutive nodes share a face, in which the way is straight.
struct SurfacePath {
  std::vector<SurfaceNode> nodes;
  double length_mm = 0.0;
  double searched_mm = 0.0;   ///< no way up to this length was left unlooked at
  bool along_border = false;  ///< bends at a border vertex: a shorter way might lead across a gap
};

/// Shortest way between two points of a patch: the strip of triangles found by A* is unfolded and
/// drawn tight (funnel), then flipped over each vertex at which the way could still be shortened.
/// The result is a geodesic: straight across every edge, with no shorter way near it.
/// Source: strips, funnel and flips as in Mancinelli, Nazzaro, Pellacini and Puppo, "b/Surf",
/// IEEE TVCG 29(7), 2023.
/// @return nothing where no way exists
[[nodiscard]] std::optional<SurfacePath> shortestPath(const SurfacePatch& patch,
                                                      const SurfaceNode& from,
                                                      const SurfaceNode& to);

}  // namespace tarsus
