#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <span>
#include <vector>

namespace tarsus {

/// From one place to the next.
struct RulerLeg {
  double surface_mm = 0.0;   ///< along the surface
  double straight_mm = 0.0;  ///< through the air
};

/// A tape laid on the model from place to place.
struct Ruler {
  std::vector<RulerLeg> legs;            ///< one fewer than places
  std::vector<SurfacePoint> line;        ///< the way, straight in each triangle; for drawing
  std::vector<Eigen::Vector3d> line_mm;  ///< the same, scan frame
  double surface_mm = 0.0;               ///< all legs along the surface
  double straight_mm = 0.0;              ///< from the first place to the last through the air
};

/// Shortest way over the surface through the places, in their order. The model is looked at only as
/// far around each leg as a shorter way could lead.
/// @param places  at least two, on this very mesh
/// @errors SurfaceIncomplete (the way leads over a hole or past the model's edge, or there is none;
///         the detail names the place)
[[nodiscard]] Expected<Ruler> layRuler(const TriangleMesh& mesh,
                                       std::span<const SurfacePoint> places);

}  // namespace tarsus
