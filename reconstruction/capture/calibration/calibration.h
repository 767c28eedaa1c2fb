#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/capture/calibration/calibration_profile.h"

#include <optional>
#include <string>
#include <vector>

namespace tarsus {

using RawImage = Image<std::uint16_t>;  ///< grey levels, or depth in the camera's units (0 = none)

/// The board as seen at one moment; an image that was not taken is empty. Nothing may move between
/// the images of one view.
struct CalibrationView {
  std::string name;
  ColorImage color;
  RawImage infrared;  ///< of the depth camera, pixel by pixel the same as `depth`
  RawImage depth;     ///< as stored: with the lens distortion, in units
};

struct CalibrationCapture {
  /// What is known beforehand: model, serial, depth unit; the depth camera where there are no
  /// infrared images. Its sizes must be those of the images.
  std::optional<RgbdCamera> nominal;
  std::vector<CalibrationView> views;
  Warnings warnings;  ///< of reading it
};

struct CalibrationOptions {
  Chessboard board;
  std::string date;  ///< ISO 8601, UTC: 2026-03-31 or 2026-03-31T09:30:00Z
  /// The board lies flat on a wall, without thickness: the whole wall in the picture is compared.
  bool board_on_wall = false;
  /// Our choice: with fewer, one bad view decides.
  int least_views = 8;
};

/// Calibrates both cameras from views of a printed chessboard: intrinsics and distortion of each
/// (Zhang, PAMI 2000; corners: Duda and Frese, BMVC 2018), all views and both cameras adjusted
/// together, then the depth against the board's plane.
///
/// Without infrared images the depth camera keeps its nominal intrinsics and place: depth images of
/// a plane tell no focal length (a plane seen with a wrong one is again a plane), so a warning says
/// so and only colour camera and depth correction are made.
/// Both cameras must be mounted the same way up, or `nominal` must tell their rotation.
/// @return  with every view used or refused, and why
/// @errors  BadOption (board, date), CameraFactsMissing (no infrared and nothing nominal, depth
///          without unit), Cancelled, CalibrationFailed (no view, sizes that change, board not
///          found, too few views, focal length undetermined, squares or depth unit not as given)
[[nodiscard]] Expected<CalibrationProfile> calibrateCameras(const CalibrationCapture& capture,
                                                            const CalibrationOptions& options,
                                                            const Job& job = {});

}  // namespace tarsus
