#pragma once

#include "reconstruction/capture/calibration/calibration.h"

#include <Eigen/Core>

#include <vector>

namespace tarsus {

/// Corners of one image, row by row [px]; empty where the board was not found.
using Corners = std::vector<Eigen::Vector2d>;

/// The inner corners on the board [mm], z = 0, in the order of Corners.
[[nodiscard]] std::vector<Eigen::Vector3d> boardPoints(const Chessboard& board);

/// Finds all inner corners, to a few hundredths of a pixel.
/// Source: Duda and Frese, BMVC 2018, as OpenCV's findChessboardCornersSB.
/// The board may come turned by 180 degrees: that cannot be seen.
[[nodiscard]] Corners findCorners(const ColorImage& image, const Chessboard& board);
/// Stretches the grey levels first: infrared images are often dark.
[[nodiscard]] Corners findCorners(const RawImage& image, const Chessboard& board);

}  // namespace tarsus
