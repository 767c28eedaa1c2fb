#include "reconstruction/capture/openni/simulated_camera/frame_player.h"

#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/image_file.h"

#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>

namespace tarsus {
namespace {

/// The infrared picture that belongs to a depth image, whether it is there or not.
std::filesystem::path infraredBeside(const std::filesystem::path& depth) {
  return depth.parent_path().parent_path() / "ir" / depth.filename();
}

/// Into the buffer that is shown; false where the image cannot be read or has another size.
bool readInto(const std::filesystem::path& path, std::vector<std::uint16_t>& buffer) {
  const auto numbers = readNumbers(path);
  if (!numbers || numbers->pixels().size() != buffer.size()) {
    return false;
  }
  std::ranges::copy(numbers->pixels(), buffer.begin());
  return true;
}

}  // namespace

Expected<std::unique_ptr<FramePlayer>> FramePlayer::open(const SimulatedAddress& address) {
  auto camera = readCamera(address.scan / "camera.json");
  if (!camera) {
    return tl::unexpected(camera.error());
  }
  auto files = listFrames(address.scan);
  if (!files) {
    return tl::unexpected(files.error());
  }
  return std::unique_ptr<FramePlayer>(
      new FramePlayer(std::move(*camera), std::move(*files), address));
}

FramePlayer::FramePlayer(RgbdCamera camera,
                         std::vector<FrameFiles> files,
                         const SimulatedAddress& address)
    : camera_(std::move(camera)),
      files_(std::move(files)),
      fault_(address.fault),
      once_(address.once) {
  const double fps = camera_.frames_per_s > 0.0 ? camera_.frames_per_s : 30.0;
  period_ = std::chrono::microseconds(std::lround(1e6 / fps));
  const auto pixels = [](const Intrinsics& i) {
    return static_cast<std::size_t>(i.width) * static_cast<std::size_t>(i.height);
  };
  depth_.resize(pixels(camera_.depth));
  color_.resize(pixels(camera_.color));
  std::error_code ignored;
  has_infrared_ = std::filesystem::exists(infraredBeside(files_.front().depth), ignored);
  infrared_.resize(has_infrared_ ? depth_.size() : 0);
}

void FramePlayer::start(std::function<void(const SensorImages&)> show) {
  stop();
  show_ = std::move(show);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void FramePlayer::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
}

void FramePlayer::run(const std::stop_token& stop) {
  pthread_setname_np(pthread_self(), kThreadName);
  // Who wants both streams has started them by then, so that none misses the first frame.
  constexpr auto kAllStarted = std::chrono::milliseconds(300);
  const auto begin = std::chrono::steady_clock::now() + kAllStarted;
  const auto count = static_cast<int>(files_.size());
  std::mutex mutex;
  std::condition_variable_any wake;
  for (int index = 0; !stop.stop_requested() && (!once_ || index < count); ++index) {
    const SensorImages images = load(index);
    {
      std::unique_lock lock(mutex);
      const auto due = once_ ? begin : begin + index * period_;
      wake.wait_until(lock, stop, due, [] { return false; });
    }
    if (!stop.stop_requested() && !held(index)) {
      show_(images);
    }
  }
}

std::size_t FramePlayer::fileOf(int index) const {
  const auto last = static_cast<int>(files_.size()) - 1;
  if (last == 0) {
    return 0;
  }
  const int place = index % (2 * last);
  return static_cast<std::size_t>(place <= last ? place : 2 * last - place);
}

std::chrono::microseconds FramePlayer::timeOf(int index) const {
  const auto count = static_cast<int>(files_.size());
  return index < count ? files_[static_cast<std::size_t>(index)].timestamp
                       : files_.back().timestamp + (index - count + 1) * period_;
}

SensorImages FramePlayer::load(int index) {
  const FrameFiles& files = files_[fileOf(index)];
  SensorImages images{.timestamp = timeOf(index), .index = index + 1};
  if (readInto(files.depth, depth_)) {
    images.depth = &depth_;
  }
  if (wants_infrared_ && has_infrared_ && readInto(infraredBeside(files.depth), infrared_)) {
    images.infrared = &infrared_;
  }
  if (const auto color = readColorImage(files.color);
      color && color->pixels().size() == color_.size()) {
    std::ranges::copy(color->pixels(), color_.begin());
    images.color = &color_;
  }
  if (faulty(index)) {
    spoil(index);
  }
  return images;
}

bool FramePlayer::faulty(int index) const {
  const double at_s = index * std::chrono::duration<double>(period_).count();
  return fault_.kind != CameraFault::Kind::None && at_s >= fault_.from_s && at_s < fault_.to_s;
}

bool FramePlayer::held(int index) const {
  return faulty(index) &&
         (fault_.kind == CameraFault::Kind::Stall || fault_.kind == CameraFault::Kind::Unplug ||
          (fault_.kind == CameraFault::Kind::Drop && index % 3 == 2));
}

void FramePlayer::spoil(int index) {
  if (fault_.kind == CameraFault::Kind::Unit) {
    for (std::uint16_t& z : depth_) {
      z = static_cast<std::uint16_t>(std::min(65000, 8 * z));
    }
  }
  if (fault_.kind == CameraFault::Kind::Garbage) {
    std::uint32_t state = 2463534242U + static_cast<std::uint32_t>(index);
    const auto next = [&state] {  // xorshift, Marsaglia 2003
      state ^= state << 13U;
      state ^= state >> 17U;
      state ^= state << 5U;
      return state;
    };
    std::ranges::generate(depth_, [&] { return static_cast<std::uint16_t>(next() >> 16U); });
    std::ranges::generate(color_, [&] {
      const std::uint32_t bits = next();
      return Rgb8{.r = static_cast<std::uint8_t>(bits),
                  .g = static_cast<std::uint8_t>(bits >> 8U),
                  .b = static_cast<std::uint8_t>(bits >> 16U)};
    });
  }
}

}  // namespace tarsus
