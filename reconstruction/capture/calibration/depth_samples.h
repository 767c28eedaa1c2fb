#pragma once

#include "reconstruction/capture/calibration/depth_fit.h"

namespace tarsus {

/// Mean of measured and true depth in a field of pixels on the board.
struct DepthSample {
  double x = 0.0;  ///< of the undistorted image, at focal length 1
  double y = 0.0;
  double measured_mm = 0.0;  ///< by the nominal unit, uncorrected
  double true_mm = 0.0;      ///< of the board's plane, same pixels
};

/// What one view says about the depth.
struct DepthSamples {
  std::vector<DepthSample> samples;  ///< by fields of 16 x 16 pixels, row by row
  double ratio = 0.0;                ///< median of true by measured
  std::string refused;               ///< why there are none
};

/// @param directions  of each pixel of the distorted image, z = 1
[[nodiscard]] DepthSamples depthSamples(const DepthView& view,
                                        const Image<Eigen::Vector2d>& directions,
                                        double mm_per_unit,
                                        const CalibrationOptions& options);

/// Directions of all pixels of a camera, its distortion taken out.
[[nodiscard]] Image<Eigen::Vector2d> pixelDirections(const Intrinsics& camera);

}  // namespace tarsus
