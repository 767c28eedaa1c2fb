#pragma once

#include "measurement/outline/surface_patch.h"

#include <optional>

namespace tarsus {

/// When a place moves to an edge: where colour or the surface's direction changes faster than
/// across it on either side, and faster than on plain skin.
struct EdgeSnapOptions {
  double radius_mm = 1.5;           ///< how far a click moves at most
  double scale_mm = 0.6;            ///< changes are seen over this distance; finer relief is noise
  double color_per_mm = 6.0;        ///< CIELAB difference per mm that makes an edge
  double crease_rad_per_mm = 0.35;  ///< turn of the normal per mm that makes a crease: a rim of
                                    ///< 45 degrees over 2 mm; skin over a toe of 7 mm has 0.14
};

/// The strongest edge of colour or crease within the radius, on the surface connected with the
/// place; a crest of change, not merely its slope. Colour counts where the model has any.
/// Source of the rule: Canny, IEEE PAMI 8(6), 1986 (maximum across the edge, above a threshold).
/// @param place  on a face of the patch
/// @return nothing where nothing is clear
[[nodiscard]] std::optional<SurfacePoint> snapToEdge(const TexturedMesh& foot,
                                                     const SurfacePatch& patch,
                                                     const SurfacePoint& place,
                                                     const EdgeSnapOptions& options = {});

}  // namespace tarsus
