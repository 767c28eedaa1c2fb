#pragma once

#include "reconstruction/capture/openni/simulated_camera/frame_player.h"

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <vector>

// OniDriverAPI.h asks for these; elsewhere they come from OpenNI's own sources.
#define XN_NEW(type, ...) new (std::nothrow) type(__VA_ARGS__)
#define XN_DELETE(p) delete (p)
#include <Driver/OniDriverAPI.h>

namespace tarsus {

/// Depth, colour or infrared of a simulated camera, as OpenNI sees it.
class SimulatedStream final : public oni::driver::StreamBase {
 public:
  SimulatedStream(class SimulatedDevice& device, OniSensorType sensor);

  OniStatus start() override;
  void stop() override;
  OniBool isPropertySupported(int property) override;
  OniStatus getProperty(int property, void* data, int* size) override;
  OniStatus setProperty(int property, const void* data, int size) override;

  /// Hands one image on; nothing while the stream is stopped.
  void show(const SensorImages& images);
  [[nodiscard]] bool running() const { return running_; }
  [[nodiscard]] OniSensorType sensor() const { return sensor_; }

 private:
  SimulatedDevice& device_;
  OniSensorType sensor_;
  OniVideoMode mode_;
  std::mutex showing_;  ///< a stream that was stopped is no longer shown to
  std::atomic<bool> running_ = false;
};

/// A scan folder that plays as a camera. Plays while a stream runs.
class SimulatedDevice final : public oni::driver::DeviceBase {
 public:
  /// @param when_first_started  called once, as the first stream starts
  SimulatedDevice(std::unique_ptr<FramePlayer> player,
                  std::string serial,
                  std::function<void()> when_first_started);
  ~SimulatedDevice() override;
  SimulatedDevice(const SimulatedDevice&) = delete;
  SimulatedDevice& operator=(const SimulatedDevice&) = delete;
  SimulatedDevice(SimulatedDevice&&) = delete;
  SimulatedDevice& operator=(SimulatedDevice&&) = delete;

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override;
  oni::driver::StreamBase* createStream(OniSensorType sensor) override;
  void destroyStream(oni::driver::StreamBase* stream) override;
  OniBool isPropertySupported(int property) override;
  OniStatus getProperty(int property, void* data, int* size) override;

  [[nodiscard]] const RgbdCamera& camera() const { return player_->camera(); }
  [[nodiscard]] OniVideoMode modeOf(OniSensorType sensor) const;
  /// A stream was started or stopped.
  void streamsChanged();

 private:
  [[nodiscard]] std::vector<std::shared_ptr<SimulatedStream>> streams();

  std::unique_ptr<FramePlayer> player_;
  std::string serial_;
  std::array<OniVideoMode, 3> modes_{};     ///< depth, colour, infrared
  std::array<OniSensorInfo, 3> sensors_{};  ///< the last where the scan has infrared pictures
  std::function<void()> when_first_started_;
  std::mutex list_;  ///< guards `streams_`
  std::vector<std::shared_ptr<SimulatedStream>> streams_;
  std::mutex control_;  ///< guards `playing_`; held while the player starts and stops
  bool playing_ = false;
};

}  // namespace tarsus
