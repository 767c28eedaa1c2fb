#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/openni/simulated_camera/address.h"
#include "reconstruction/scene/frame.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace tarsus {

/// One exposure as a sensor gives it.
struct SensorImages {
  std::chrono::microseconds timestamp{};
  int index = 0;
  const std::vector<std::uint16_t>* depth = nullptr;     ///< units of the camera; null: unreadable
  const std::vector<Rgb8>* color = nullptr;              ///< null: none, or unreadable
  const std::vector<std::uint16_t>* infrared = nullptr;  ///< grey levels; null: none, unreadable
};

/// Plays a scan folder at its own rate, to its end and back again, so that the camera never jumps.
/// Forwards, the first time, timestamps are those of the scan; later ones go on from there.
/// A frame is decoded (about 5 ms) in the time left until it is due.
/// A scan may have an infrared picture beside a depth image: ir/NAME.png beside depth/NAME.png.
class FramePlayer {
 public:
  /// Its thread's name, by which a benchmark finds what the camera itself costs.
  static constexpr const char* kThreadName = "tarsus-camera";

  /// @errors those of readCamera and listFrames
  [[nodiscard]] static Expected<std::unique_ptr<FramePlayer>> open(const SimulatedAddress& address);

  [[nodiscard]] const RgbdCamera& camera() const { return camera_; }
  [[nodiscard]] bool hasInfrared() const { return has_infrared_; }
  /// Decoded only while somebody looks at it.
  void wantInfrared(bool wanted) { wants_infrared_ = wanted; }
  /// Calls `show` for each frame, from a thread of its own, until `stop` returns.
  void start(std::function<void(const SensorImages&)> show);
  void stop();

 private:
  FramePlayer(RgbdCamera camera, std::vector<FrameFiles> files, const SimulatedAddress& address);
  void run(const std::stop_token& stop);
  [[nodiscard]] std::size_t fileOf(int index) const;
  [[nodiscard]] std::chrono::microseconds timeOf(int index) const;
  [[nodiscard]] SensorImages load(int index);
  void spoil(int index);
  [[nodiscard]] bool held(int index) const;
  [[nodiscard]] bool faulty(int index) const;

  RgbdCamera camera_;
  std::vector<FrameFiles> files_;
  CameraFault fault_;
  bool once_;
  bool has_infrared_ = false;
  std::atomic<bool> wants_infrared_ = false;
  std::chrono::microseconds period_{};
  std::vector<std::uint16_t> depth_;
  std::vector<Rgb8> color_;
  std::vector<std::uint16_t> infrared_;
  std::function<void(const SensorImages&)> show_;
  std::jthread thread_;
};

}  // namespace tarsus
