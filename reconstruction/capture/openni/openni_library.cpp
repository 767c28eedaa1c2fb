#include "reconstruction/capture/openni/openni_library.h"

#include "reconstruction/capture/device_profile.h"
#include "reconstruction/capture/openni/plain_path.h"
#include "reconstruction/capture/openni/simulated_camera/address.h"

#include <OpenNI.h>

#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <future>
#include <mutex>
#include <stop_token>
#include <thread>

namespace tarsus {
namespace {

std::mutex held_mutex;
std::weak_ptr<OpenNiLibrary> held;  // guarded by held_mutex

/// Does what it is given, one piece after the other.
class Worker {
 public:
  void run(const std::function<void()>& work) {
    if (std::this_thread::get_id() == thread_.get_id()) {
      work();
      return;
    }
    std::packaged_task<void()> task(work);
    auto done = task.get_future();
    {
      const std::scoped_lock lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
    done.get();
  }

 private:
  void serve(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [&] { return !tasks_.empty(); })) {
      auto task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;  ///< guards `tasks_`
  std::condition_variable_any changed_;
  std::deque<std::packaged_task<void()>> tasks_;
  std::jthread thread_{[this](const std::stop_token& stop) { serve(stop); }};
};

CameraInfo infoOf(const openni::DeviceInfo& device, const std::vector<DeviceProfile>& profiles) {
  CameraInfo info{.uri = device.getUri(), .vendor = device.getVendor(), .name = device.getName()};
  const DeviceProfile* profile = profileOf(info.vendor + " " + info.name, profiles);
  info.profile = profile != nullptr ? profile->name : "";
  info.simulated = info.uri.starts_with(kSimulatedScheme);
  return info;
}

}  // namespace

void onOpenNiThread(const std::function<void()>& work) {
  static Worker worker;
  worker.run(work);
}

Expected<std::shared_ptr<OpenNiLibrary>> OpenNiLibrary::hold() {
  const std::scoped_lock lock(held_mutex);
  if (auto library = held.lock()) {
    return library;
  }
  // Our driver reads it as OpenNI starts.
  if (const char* announced = std::getenv(kSimulatedVariable); announced != nullptr) {
    const auto plain = plainUri(announced);
    if (!plain) {
      return tl::unexpected(plain.error());
    }
    setenv(kSimulatedVariable, plain->c_str(), 1);
  }
  std::string why;
  bool started = false;
  onOpenNiThread([&] {
    started = openni::OpenNI::initialize() == openni::STATUS_OK;
    if (!started) {
      why = openni::OpenNI::getExtendedError();
      openni::OpenNI::shutdown();
    }
  });
  if (!started) {
    return fail(ErrorCode::CameraFailed, "OpenNI2 does not start: " + why);
  }
  std::shared_ptr<OpenNiLibrary> library(new OpenNiLibrary);
  held = library;
  return library;
}

OpenNiLibrary::~OpenNiLibrary() {
  onOpenNiThread([] { openni::OpenNI::shutdown(); });
}

Expected<std::vector<CameraInfo>> listCameras() {
  const auto library = OpenNiLibrary::hold();
  if (!library) {
    return tl::unexpected(library.error());
  }
  const auto profiles = deviceProfiles();
  std::vector<CameraInfo> cameras;
  onOpenNiThread([&] {
    openni::Array<openni::DeviceInfo> devices;
    openni::OpenNI::enumerateDevices(&devices);
    for (int i = 0; i < devices.getSize(); ++i) {
      cameras.push_back(infoOf(devices[i], profiles));
    }
  });
  return cameras;
}

std::string simulatedUri(const std::string& scan, const std::string& fault) {
  std::error_code ignored;
  std::string uri =
      std::string(kSimulatedScheme) + std::filesystem::absolute(scan, ignored).string();
  return fault.empty() ? uri : uri + "?fault=" + fault;
}

void announceSimulatedCamera(const std::string& scan, const std::string& fault) {
  setenv(kSimulatedVariable, simulatedUri(scan, fault).c_str(), 1);
}

}  // namespace tarsus
