#pragma once

#include "reconstruction/base/error.h"

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tarsus {

/// Runs `work` on the one thread that calls OpenNI, which lives as long as the program, and waits
/// for its end: OpenNI2 remembers every thread that ever called it, asks the system about each of
/// them at the next call of a new one, and crashes where one has ended.
void onOpenNiThread(const std::function<void()>& work);

/// To be waited between the stop of a device's streams and their end: without it OpenNI crashes at
/// one end in four.
inline constexpr std::chrono::milliseconds kSettle{60};

/// OpenNI2, started with the first holder and shut down after the last: starting takes a second and
/// looks for devices. Any thread.
class OpenNiLibrary {
 public:
  /// @errors CameraFailed where OpenNI does not start (its drivers are missing)
  [[nodiscard]] static Expected<std::shared_ptr<OpenNiLibrary>> hold();
  ~OpenNiLibrary();
  OpenNiLibrary(const OpenNiLibrary&) = delete;
  OpenNiLibrary& operator=(const OpenNiLibrary&) = delete;
  OpenNiLibrary(OpenNiLibrary&&) = delete;
  OpenNiLibrary& operator=(OpenNiLibrary&&) = delete;

 private:
  OpenNiLibrary() = default;
};

/// A depth camera that is plugged in.
struct CameraInfo {
  std::string uri;  ///< by which it is opened
  std::string vendor;
  std::string name;
  std::string profile;  ///< resources/devices; empty: not known, its depth is to be doubted
  bool simulated = false;
};

/// @errors CameraFailed
[[nodiscard]] Expected<std::vector<CameraInfo>> listCameras();

/// A recorded scan played as a camera (simulated_camera/address.h), found by listCameras from now
/// on in this process; before the first holder of the library.
/// @param fault  what it does wrong, as in an address: "unplug,2,4"; empty: nothing
void announceSimulatedCamera(const std::string& scan, const std::string& fault = {});
/// Its address, as openCamera takes it.
[[nodiscard]] std::string simulatedUri(const std::string& scan, const std::string& fault = {});

}  // namespace tarsus
