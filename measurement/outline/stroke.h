#pragma once

#include "measurement/outline/outline_edits.h"

namespace tarsus {

struct StrokeOptions {
  double tolerance_mm =
      0.4;                ///< the outline leaves the stroke by no more, but for the hand's tremor
  double reach_mm = 3.0;  ///< ends within this of a closed outline replace a piece of it
  ClickOptions click;
};

/// Draws freehand. On a closed outline, a stroke that starts and ends on it replaces the piece of
/// it that runs beside the stroke. Otherwise the stroke becomes the outline: its ends are joined,
/// and where they run past each other the rest is cut off.
/// @param stroke_mm  places as the pen met them, scan frame [mm]
/// @errors in problem(): OutlineOffSurface; OutlineInvalid where the stroke is a dot, or does not
///         meet the closed outline and is not closed itself
[[nodiscard]] OutlineEditor drawStroke(const OutlineEditor& editor,
                                       std::span<const Eigen::Vector3d> stroke_mm,
                                       const StrokeOptions& options = {});

}  // namespace tarsus
