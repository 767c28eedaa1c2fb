#pragma once

#include "reconstruction/capture/calibration/camera_fit.h"

namespace tarsus {

/// Corners of one view in both cameras; empty: not used there.
struct JointView {
  Corners color;
  Corners infrared;
};

struct JointFit {
  LensParameters color{};
  LensParameters depth{};
  bool color_k3_free = false;
  bool depth_k3_free = false;
  RigidTransform color_from_depth = RigidTransform::Identity();
  std::vector<std::optional<RigidTransform>> color_from_board;  ///< by view; empty: not used
  // what the adjustment finds about itself
  std::vector<double> color_rms_px;     ///< by view; negative: not used
  std::vector<double> infrared_rms_px;  ///< likewise
  LensParameters color_deviation{};
  LensParameters depth_deviation{};
  std::array<double, 3> rotation_deviation_rad{};
  std::array<double, 3> translation_deviation_mm{};
};

/// Adjusts both cameras, their relative place and every board together: least squares of the
/// corners' distances, each camera weighted by its own noise. Standard deviations from the
/// covariance, scaled by the residuals.
/// @param start  from fitCamera
/// @return  empty where the adjustment found no minimum
[[nodiscard]] std::optional<JointFit> adjustJointly(const std::vector<JointView>& views,
                                                    const Chessboard& board,
                                                    JointFit start);

}  // namespace tarsus
