#pragma once

#include "reconstruction/capture/calibration/calibration.h"

#include <optional>
#include <vector>

namespace tarsus {

/// The depth of one view beside the pose of its board.
struct DepthView {
  const RawImage* depth = nullptr;  ///< null: none
  std::optional<RigidTransform> depth_from_board;
};

struct DepthResult {
  std::optional<DepthCorrection> correction;  ///< empty: too few views
  DepthFit fit;
  std::vector<std::string> refused;  ///< by view; empty: used
  std::vector<std::optional<double>> rms_mm;
  Warnings warnings;
};

/// Compares measured depth with the plane of the board, pixel by pixel, and fits the correction of
/// depth_correction.h: scale alone, or with constant, quadratic, linear in z and square in z terms,
/// whichever few predict views that were left out as well as more would.
/// @param camera  depth camera with its distortion
/// @errors CalibrationFailed (squares or depth unit are not as given)
[[nodiscard]] Expected<DepthResult> fitDepth(const std::vector<DepthView>& views,
                                             const RgbdCamera& camera,
                                             const CalibrationOptions& options);

}  // namespace tarsus
