#include "reconstruction/pipeline/live_calibration.h"

#include "reconstruction/capture/calibration/calibration_folder.h"
#include "reconstruction/capture/camera_file.h"

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <utility>

namespace tarsus {
namespace {

using Clock = std::chrono::steady_clock;
using Frame = std::shared_ptr<const RgbdFrame>;

/// The newest frame of a camera: a look takes longer than a period.
class Newest {
 public:
  void put(RgbdFrame frame) {
    const std::scoped_lock lock(mutex_);
    frame_ = std::make_shared<const RgbdFrame>(std::move(frame));
    came_.notify_one();
  }
  /// Nothing where none came in time. Frames from before this call are passed over.
  Frame next(std::chrono::milliseconds most) {
    std::unique_lock lock(mutex_);
    frame_.reset();
    came_.wait_for(lock, most, [&] { return frame_ != nullptr; });
    return std::exchange(frame_, nullptr);
  }

 private:
  std::mutex mutex_;  ///< guards `frame_`
  std::condition_variable came_;
  Frame frame_;
};

std::string viewName(int number) {
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "%04d", number);
  return name.data();
}

/// The views of one camera, one after the other.
class Taking {
 public:
  Taking(OpenNiCamera& camera,
         const std::filesystem::path& folder,
         const LiveCalibrationOptions& options)
      : camera_(camera),
        folder_(folder),
        options_(options),
        collector_(options.board, camera.camera().color.width),
        number_of_first_(freeNumber(folder)) {}

  [[nodiscard]] Newest& newest() { return newest_; }
  [[nodiscard]] int taken() const { return collector_.taken(); }

  Expected<BoardLook> look(const RgbdFrame& frame) {
    const BoardLook look = collector_.add(frame.timestamp, frame.color);
    if (look != BoardLook::Taken) {
      return look;
    }
    CalibrationView view{.name = viewName(number_of_first_ + taken() - 1),
                         .color = frame.color,
                         .infrared = {},
                         .depth = rawDepth(frame.depth, camera_.camera().depth_units_per_m)};
    if (options_.infrared) {
      auto infrared = camera_.infrared();
      if (!infrared) {
        return tl::unexpected(infrared.error());
      }
      view.infrared = std::move(*infrared);
      if (!heldStill()) {
        collector_.forgetLast();
        return BoardLook::Moving;
      }
    }
    if (auto written = writeCalibrationView(folder_, view); !written) {
      return tl::unexpected(written.error());
    }
    return look;
  }

 private:
  /// Colour needs some frames to come back after the infrared picture.
  bool heldStill() {
    constexpr auto kMost = std::chrono::milliseconds(500);
    constexpr int kTries = 4;
    for (int i = 0; i < kTries; ++i) {
      const Frame frame = newest_.next(kMost);
      if (frame && frame->color.width() > 0) {
        return collector_.stillAsTaken(frame->color);
      }
    }
    return false;
  }

  /// Views that are there already stay.
  static int freeNumber(const std::filesystem::path& folder) {
    std::error_code ignored;
    int number = 1;
    while (std::filesystem::exists(folder / "color" / (viewName(number) + ".png"), ignored)) {
      ++number;
    }
    return number;
  }

  OpenNiCamera& camera_;
  const std::filesystem::path& folder_;
  const LiveCalibrationOptions& options_;
  ViewCollector collector_;
  int number_of_first_;
  Newest newest_;
};

}  // namespace

Expected<int> takeCalibrationViews(OpenNiCamera& camera,
                                   const std::filesystem::path& folder,
                                   const LiveCalibrationOptions& options,
                                   const std::function<void(const LiveCalibrationView&)>& tell,
                                   const Job& job) {
  constexpr auto kWait = std::chrono::milliseconds(500);
  constexpr int kMostWaits = 20;
  if (options.infrared && !camera.hasInfrared()) {
    return fail(ErrorCode::BadOption,
                "this camera gives no infrared pictures; add --no-infrared, and the depth camera's "
                "lens stays nominal");
  }
  if (auto written = writeCamera(folder / "camera.json", camera.camera()); !written) {
    return tl::unexpected(written.error());
  }
  Taking taking(camera, folder, options);
  const auto started =
      camera.start([&](RgbdFrame frame) { taking.newest().put(std::move(frame)); });
  if (!started) {
    return tl::unexpected(started.error());
  }
  Expected<void> ended;
  auto last_taken = Clock::now();
  for (int waits = 0; ended && taking.taken() < options.views && !job.stopped();) {
    const Frame frame = taking.newest().next(kWait);
    if (!frame) {
      if (++waits == kMostWaits) {
        ended = fail(ErrorCode::CameraFailed, "no frame came for 10 s");
      }
      continue;
    }
    waits = 0;
    if (Clock::now() - last_taken > std::chrono::seconds(options.patience_s)) {
      ended = fail(ErrorCode::CalibrationFailed,
                   "no new view for " + std::to_string(options.patience_s) +
                       " s; are rows and columns of the board as given (inner corners)?");
      continue;
    }
    if (frame->color.width() == 0) {
      continue;
    }
    const auto look = taking.look(*frame);
    if (look) {
      last_taken = *look == BoardLook::Taken ? Clock::now() : last_taken;
      tell({.look = *look, .taken = taking.taken(), .frame = frame});
    } else {
      ended = tl::unexpected(look.error());
    }
  }
  camera.stop();
  return ended ? Expected<int>(taking.taken()) : tl::unexpected(ended.error());
}

}  // namespace tarsus
