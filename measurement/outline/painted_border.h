#pragma once

#include "measurement/outline/outline_trace.h"
#include "measurement/outline/painted_region.h"

namespace tarsus {

/// A painted region as an outline.
struct PaintedBorder {
  TracedOutline outline;                  ///< with hash, as smooth as the brush; `clicks` are empty
  std::vector<Eigen::Vector3d> curve_mm;  ///< closed: drawStroke makes clicks of it
  Warnings warnings;  ///< painted_parts: only the largest is outlined; painted_holes: filled in
};

/// The border of the largest part of a region, its holes filled.
/// @errors OutlineInvalid (nothing is painted), SurfaceIncomplete (it runs into a hole or the
///         model's edge)
[[nodiscard]] Expected<PaintedBorder> borderOf(const PaintedRegion& region);

}  // namespace tarsus
