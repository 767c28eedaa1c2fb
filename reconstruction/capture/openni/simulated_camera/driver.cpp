// An OpenNI2 driver whose cameras are scan folders: the whole path of a real camera without one.
#include "reconstruction/capture/openni/simulated_camera/device.h"

#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace tarsus {
namespace {

OniDeviceInfo infoOf(const std::string& uri) {
  OniDeviceInfo info{};
  std::snprintf(info.uri, sizeof info.uri, "%s", uri.c_str());
  std::snprintf(info.vendor, sizeof info.vendor, "%s", kSimulatedVendor);
  std::snprintf(info.name, sizeof info.name, "Simulated camera");
  return info;
}

class SimulatedDriver final : public oni::driver::DriverBase {
 public:
  explicit SimulatedDriver(OniDriverServices* services) : DriverBase(services) {}
  ~SimulatedDriver() override = default;
  SimulatedDriver(const SimulatedDriver&) = delete;
  SimulatedDriver& operator=(const SimulatedDriver&) = delete;
  SimulatedDriver(SimulatedDriver&&) = delete;
  SimulatedDriver& operator=(SimulatedDriver&&) = delete;

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback state_changed,
                       void* cookie) override {
    const OniStatus status = DriverBase::initialize(connected, disconnected, state_changed, cookie);
    const char* announced = std::getenv(kSimulatedVariable);
    if (status == ONI_STATUS_OK && announced != nullptr) {
      tryDevice(announced);
    }
    return status;
  }

  OniStatus tryDevice(const char* uri) override {
    const auto address = parseSimulatedAddress(uri);
    if (!address || !FramePlayer::open(*address)) {
      return ONI_STATUS_ERROR;
    }
    const OniDeviceInfo info = infoOf(uri);
    deviceConnected(&info);
    return ONI_STATUS_OK;
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    auto address = parseSimulatedAddress(uri);
    if (!address) {
      return nullptr;
    }
    const bool unplugs = address->fault.kind == CameraFault::Kind::Unplug;
    if (const std::scoped_lock lock(mutex_); unplugs && unplugged_.contains(uri)) {
      address->fault = {};  // once is enough
    }
    auto player = FramePlayer::open(*address);
    if (!player) {
      return nullptr;
    }
    const std::string serial = "simulated " + address->scan.filename().string();
    std::function<void()> tell;
    if (address->fault.kind == CameraFault::Kind::Unplug) {
      tell = [this, name = std::string(uri), fault = address->fault] { unplugLater(name, fault); };
    }
    return new (std::nothrow) SimulatedDevice(std::move(*player), serial, std::move(tell));
  }

  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

  void shutdown() override { plug_ = {}; }

 private:
  void unplugLater(const std::string& uri, const CameraFault& fault) {
    plug_ = std::jthread([this, uri, fault](const std::stop_token& stop) {
      std::mutex mutex;
      std::condition_variable_any wake;
      const auto begin = std::chrono::steady_clock::now();
      const auto passed = [&](double s) {
        std::unique_lock lock(mutex);
        wake.wait_until(
            lock, stop, begin + std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * s)), [] {
              return false;
            });
        return !stop.stop_requested();
      };
      const OniDeviceInfo info = infoOf(uri);
      if (passed(fault.from_s)) {
        {
          const std::scoped_lock lock(mutex_);
          unplugged_.insert(uri);
        }
        deviceDisconnected(&info);
      }
      constexpr double kForGood_s = 1e6;
      if (fault.to_s < kForGood_s && passed(fault.to_s)) {
        deviceConnected(&info);
      }
    });
  }

  std::mutex mutex_;  ///< guards `unplugged_`
  std::set<std::string> unplugged_;
  std::jthread plug_;
};

}  // namespace
}  // namespace tarsus

// The names are OpenNI's.
ONI_EXPORT_DRIVER(tarsus::SimulatedDriver)
