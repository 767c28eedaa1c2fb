#pragma once

#include "reconstruction/capture/calibration/calibration.h"

#include <filesystem>

namespace tarsus {

/// Reads a folder of calibration views:
///   color/NNNN.png or .jpg   colour, 8 bit
///   ir/NNNN.png              infrared of the depth camera, grey, 8 or 16 bit    (may be absent)
///   depth/NNNN.png           depth, 16 bit, units of the camera, as stored      (may be absent)
///   camera.json              the camera as known so far: design.md section 3    (see below)
/// Files of the same name (without ending) are one view; any name will do. The board must not move
/// within a view. Images are as the camera gives them, with the lens distortion. Where the infrared
/// projector of the camera draws a pattern, cover it for ir/ and uncover it for depth/.
/// camera.json must be there where there are depth images (their unit) or no infrared images (the
/// depth camera). At most 100 views are read, evenly chosen; others are told in a warning, as is
/// each file that cannot be read.
/// @param nominal  used where the folder has no camera.json
/// @errors FileMissing (no folder), CameraFactsInvalid, CalibrationFailed (no image that can be
///         read)
[[nodiscard]] Expected<CalibrationCapture> readCalibrationFolder(
    const std::filesystem::path& folder, std::optional<RgbdCamera> nominal = std::nullopt);

/// Writes one view into such a folder; pictures that are empty are left out.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeCalibrationView(const std::filesystem::path& folder,
                                                  const CalibrationView& view);

/// The depth of a frame as the sensor's numbers.
[[nodiscard]] RawImage rawDepth(const DepthImage& depth_mm, double units_per_m);

/// Chooses views among the frames of a recorded scan in which a board was held still in many ways.
/// It holds no infrared pictures, so the depth camera stays nominal.
/// @errors those of readCamera and listFrames; CalibrationFailed (no view), Cancelled
[[nodiscard]] Expected<CalibrationCapture> viewsOfScan(const std::filesystem::path& scan,
                                                       const Chessboard& board,
                                                       const Job& job = {});

}  // namespace tarsus
