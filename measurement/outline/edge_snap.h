#pragma once

#include "measurement/outline/surface_patch.h"

#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// When a place moves to an edge: where the surface's direction or the colour changes faster than
/// across it on either side, and faster than on plain skin.
struct EdgeSnapOptions {
  double radius_mm = 1.5;           ///< how far a click moves at most
  double scale_mm = 0.6;            ///< changes are seen over this distance; finer relief is noise
  double crease_rad_per_mm = 0.35;  ///< turn of the normal per mm that makes a crease: a rim of
                                    ///< 45 degrees over 2 mm; skin over a toe of 7 mm has 0.14
  double color_per_mm = 6.0;        ///< CIELAB difference per mm that makes an edge
};

/// A place on an edge near another place.
struct EdgePlace {
  SurfacePoint point;
  double strength = 0.0;  ///< in thresholds, >= 1
  double moved_mm = 0.0;  ///< laid flat
};

/// Edges near a place on the surface connected with it; crests of change, not their slopes. Creases
/// alone where there is one: the rim is the wound's margin, while colours also change across
/// inflamed skin outside it and slough inside. Else edges of colour, where the model has any.
/// Source of the rule: Canny, IEEE PAMI 8(6), 1986 (maximum across the edge, above a threshold).
/// @param place  on a face of the patch
[[nodiscard]] std::vector<EdgePlace> edgesNear(const TexturedMesh& foot,
                                               const SurfacePatch& patch,
                                               const SurfacePoint& place,
                                               const EdgeSnapOptions& options = {});

/// The strongest of them, nearer ones first; nothing where nothing is clear.
[[nodiscard]] std::optional<SurfacePoint> snapToEdge(const TexturedMesh& foot,
                                                     const SurfacePatch& patch,
                                                     const SurfacePoint& place,
                                                     const EdgeSnapOptions& options = {});

/// All places of a stroke moved to edges together: neighbours move alike, and where the edge ends
/// or jumps they stay rather than jump. The best such choice, by dynamic programming.
[[nodiscard]] std::vector<SurfacePoint> snapStrokeToEdges(const TexturedMesh& foot,
                                                          const SurfacePatch& patch,
                                                          std::span<const SurfacePoint> stroke,
                                                          const EdgeSnapOptions& options = {});

}  // namespace tarsus
