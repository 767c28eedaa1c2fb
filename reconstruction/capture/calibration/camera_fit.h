#pragma once

#include "reconstruction/capture/calibration/chessboard.h"

#include <array>
#include <optional>
#include <vector>

namespace tarsus {

/// fx, fy, cx, cy [px], k1, k2, p1, p2, k3.
using LensParameters = std::array<double, 9>;

/// One camera by itself: the start of the joint adjustment.
struct SingleCameraFit {
  LensParameters lens{};
  bool k3_free = false;                                          ///< it was told apart from 0
  std::vector<std::optional<RigidTransform>> camera_from_board;  ///< by view; empty: refused
  std::vector<double> rms_px;                                    ///< by view; of refused ones too
};

/// Zhang's calibration (PAMI 2000, as OpenCV has it). Views that do not fit the others are left out
/// one by one, the worst first; k3 stays 0 where it is less than three of its standard deviations.
/// @param corners  by view; empty where the board was not found
/// @errors CalibrationFailed: too few views, or focal length undetermined
[[nodiscard]] Expected<SingleCameraFit> fitCamera(const std::vector<Corners>& corners,
                                                  int width,
                                                  int height,
                                                  const CalibrationOptions& options);

/// The worst view, if it is an outlier among the views that are used.
/// @param rms_px  negative: not used
[[nodiscard]] std::optional<std::size_t> outlier(const std::vector<double>& rms_px);

/// The greatest angle between the normals of two boards.
[[nodiscard]] double greatestTurn(const std::vector<std::optional<RigidTransform>>& boards);

}  // namespace tarsus
