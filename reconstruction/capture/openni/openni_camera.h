#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace tarsus {

enum class CameraState {
  Stopped,
  Streaming,
  Silent,     ///< no frame for half a second
  Unplugged,  ///< gone; goes on by itself when it comes back
};

/// What became of the frames so far.
struct CaptureCounts {
  int pairs = 0;      ///< handed on
  int dropped = 0;    ///< depth frames that the sensor made and nobody got, by their numbers
  int unpaired = 0;   ///< depth frames without a colour frame within half a period
  int unplugged = 0;  ///< times
};

/// A depth camera with a colour camera beside it, through OpenNI2: the closest-range depth mode at
/// the rate of the colour mode, 640 x 480 where there is a choice. Frames are handed on as the
/// sensor gives them: with lens distortion, depth in mm by the camera's unit, uncorrected.
class OpenNiCamera {
 public:
  /// @param uri  of listCameras, or a simulated camera's address; empty: the first found
  /// @errors CameraNotFound, CameraFailed, and those of readCamera for a simulated camera
  [[nodiscard]] static Expected<std::unique_ptr<OpenNiCamera>> open(const std::string& uri = {});
  ~OpenNiCamera();
  OpenNiCamera(const OpenNiCamera&) = delete;
  OpenNiCamera& operator=(const OpenNiCamera&) = delete;
  OpenNiCamera(OpenNiCamera&&) = delete;
  OpenNiCamera& operator=(OpenNiCamera&&) = delete;

  /// As the sensor is: with distortion. From the calibration, or nominal (see warnings).
  [[nodiscard]] const RgbdCamera& camera() const;
  /// What is doubtful about it beside its calibration: `depth_unit_assumed`.
  [[nodiscard]] const Warnings& warnings() const;
  /// A simulated camera knows its own lenses; of others only a calibration tells them.
  [[nodiscard]] bool describesItself() const;

  /// Frames come from a thread of the camera's own until `stop` returns; what is called must not
  /// take longer than a frame's period, or frames are dropped. Numbered from 0 without gaps.
  /// @errors CameraFailed
  [[nodiscard]] Expected<void> start(std::function<void(RgbdFrame)> take);
  void stop();
  [[nodiscard]] bool hasInfrared() const;
  /// One picture of the depth camera's infrared sensor, as deep as it gives it, while the camera
  /// runs. Colour stands still meanwhile (many cameras give only one of both), and depth frames are
  /// missed. At most two seconds.
  /// @errors CameraFailed (no such sensor, or it gives no picture)
  [[nodiscard]] Expected<Image<std::uint16_t>> infrared();
  [[nodiscard]] CameraState state() const;
  [[nodiscard]] CaptureCounts counts() const;

 private:
  struct State;
  explicit OpenNiCamera(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
