#pragma once

#include "reconstruction/base/job.h"
#include "reconstruction/capture/calibration/calibration.h"
#include "reconstruction/capture/calibration/view_collector.h"
#include "reconstruction/capture/openni/openni_camera.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace tarsus {

struct LiveCalibrationOptions {
  Chessboard board;
  int views = 20;  ///< then it ends
  /// Of each view also the depth camera's infrared picture, without which that camera stays
  /// nominal. Where its projector's pattern hides the corners, light the board and cover it.
  bool infrared = true;
  int patience_s = 120;  ///< without a new view, then it ends
};

/// What a screen shows while views are taken.
struct LiveCalibrationView {
  BoardLook look = BoardLook::NotFound;
  int taken = 0;
  std::shared_ptr<const RgbdFrame> frame;
};

/// Takes views of a board that somebody holds before the camera, still for a moment in each place,
/// into a folder as readCalibrationFolder reads it, until there are enough of them or the job is
/// stopped (which is no error: those taken are kept). Views that the folder holds stay. The camera
/// must be stopped.
/// @param tell  called after each look, some times a second, from the caller's thread
/// @return  how many were taken
/// @errors  BadOption (no infrared sensor), CameraFailed (no frame for 10 s), CalibrationFailed
/// (patience at
///          its end), FileUnwritable, DiskFull
[[nodiscard]] Expected<int> takeCalibrationViews(
    OpenNiCamera& camera,
    const std::filesystem::path& folder,
    const LiveCalibrationOptions& options,
    const std::function<void(const LiveCalibrationView&)>& tell,
    const Job& job = {});

}  // namespace tarsus
