#pragma once

#include "reconstruction/capture/calibration/capture_check.h"
#include "reconstruction/capture/calibration/joint_fit.h"

namespace tarsus {

/// Corners by view; empty: the board was not found.
struct Found {
  std::vector<Corners> color;
  std::vector<Corners> infrared;
};

/// Each camera by itself.
struct Fits {
  SingleCameraFit color;
  std::optional<SingleCameraFit> depth;
};

/// All that was found on the way.
struct Stages {
  Found found;
  Fits fits;
  std::vector<JointView> views;  ///< as used in the end
  JointFit joint;
};

/// Cameras, how well they are known, and warnings of what is weak.
void fillCameras(const Stages& stages, const Sizes& sizes, CalibrationProfile& profile);

/// Reasons of refusal and residuals, view by view.
void fillViews(const CalibrationCapture& capture,
               const Stages& stages,
               CalibrationProfile& profile);

}  // namespace tarsus
