#include "reconstruction/capture/openni/openni_camera.h"

#include "reconstruction/base/require.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/openni/camera_facts.h"
#include "reconstruction/capture/openni/openni_frames.h"
#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/openni/plain_path.h"
#include "reconstruction/capture/openni/simulated_camera/address.h"

#include <OpenNI.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <tuple>
#include <vector>

namespace tarsus {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr auto kSilence = milliseconds(500);
constexpr auto kWait = milliseconds(30);

/// Hears of this camera being unplugged and plugged in, from OpenNI's threads.
class PlugListener final : public openni::OpenNI::DeviceConnectedListener,
                           public openni::OpenNI::DeviceDisconnectedListener {
 public:
  PlugListener() {
    openni::OpenNI::addDeviceConnectedListener(this);
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  ~PlugListener() override {
    openni::OpenNI::removeDeviceConnectedListener(this);
    openni::OpenNI::removeDeviceDisconnectedListener(this);
  }
  PlugListener(const PlugListener&) = delete;
  PlugListener& operator=(const PlugListener&) = delete;
  PlugListener(PlugListener&&) = delete;
  PlugListener& operator=(PlugListener&&) = delete;

  void watch(const std::string& uri) {
    const std::scoped_lock lock(mutex_);
    uri_ = uri;
    there_ = true;
  }
  [[nodiscard]] bool there() const { return there_; }

 private:
  void onDeviceConnected(const openni::DeviceInfo* info) override { note(info, true); }
  void onDeviceDisconnected(const openni::DeviceInfo* info) override { note(info, false); }
  void note(const openni::DeviceInfo* info, bool there) {
    const std::scoped_lock lock(mutex_);
    if (uri_ == info->getUri()) {
      there_ = there;
    }
  }

  std::mutex mutex_;  ///< guards `uri_`
  std::string uri_;
  std::atomic<bool> there_ = true;
};

/// The mode of the first of these formats, of this rate and 640 x 480, or nearest to it.
std::optional<openni::VideoMode> bestMode(const openni::SensorInfo& sensor,
                                          const std::vector<openni::PixelFormat>& formats,
                                          int frames_per_s) {
  constexpr int kWidth = 640;
  constexpr int kHeight = 480;
  const auto& modes = sensor.getSupportedVideoModes();
  std::optional<openni::VideoMode> best;
  const auto order = [&](const openni::VideoMode& mode) {
    const auto format = std::ranges::find(formats, mode.getPixelFormat()) - formats.begin();
    const int size_off = std::abs(mode.getResolutionX() * mode.getResolutionY() - kWidth * kHeight);
    return std::tuple(std::abs(mode.getFps() - frames_per_s), size_off, format);
  };
  for (int i = 0; i < modes.getSize(); ++i) {
    if (std::ranges::find(formats, modes[i].getPixelFormat()) != formats.end() &&
        (!best || order(modes[i]) < order(*best))) {
      best = modes[i];
    }
  }
  return best;
}

std::string extendedError() { return openni::OpenNI::getExtendedError(); }

}  // namespace

struct OpenNiCamera::State {
  std::shared_ptr<OpenNiLibrary> library;  ///< first, so that it goes last
  std::unique_ptr<PlugListener> plug;
  std::string uri;
  openni::Device device;
  openni::VideoStream depth;
  openni::VideoStream color;
  CameraFacts facts;
  std::function<void(RgbdFrame)> give;
  std::jthread thread;
  std::atomic<CameraState> now = CameraState::Stopped;
  mutable std::mutex mutex;  ///< guards `counts`
  CaptureCounts counts;

  // Of the capturing thread.
  std::optional<FramePairing> pairing;
  int frames = 0;
  int last_sensor_index = -1;
  microseconds last_time{-1};
  microseconds time_offset{};
  bool rebase = false;  ///< the next time stands for `time_offset`
  Clock::time_point last_seen;

  ~State() {
    if (thread.joinable()) {
      thread.request_stop();
      thread.join();
    }
    close();
    onOpenNiThread([&] { plug.reset(); });
  }

  // Each of these by OpenNI's thread.
  Expected<void> openDevice();
  [[nodiscard]] DriverFacts driverFacts();
  Expected<void> startStreams();
  void stopStreams();
  void close();

  // These on it.
  Expected<void> openHere();
  Expected<void> createStreams();
  Expected<InfraredImage> infraredHere();
  [[nodiscard]] DriverFacts factsHere();

  void run(const std::stop_token& stop);
  void comeBack(const std::stop_token& stop);
  void take(SensorImage image);
  void handOn(bool last);
};

Expected<void> OpenNiCamera::State::openDevice() {
  Expected<void> opened;
  onOpenNiThread([&] { opened = openHere(); });
  return opened;
}

Expected<void> OpenNiCamera::State::openHere() {
  if (device.open(uri.c_str()) != openni::STATUS_OK) {
    return fail(ErrorCode::CameraNotFound, uri + ": " + extendedError());
  }
  auto created = createStreams();
  if (!created) {
    close();
  }
  return created;
}

Expected<void> OpenNiCamera::State::createStreams() {
  const auto* depth_sensor = device.getSensorInfo(openni::SENSOR_DEPTH);
  const auto* color_sensor = device.getSensorInfo(openni::SENSOR_COLOR);
  if (depth_sensor == nullptr || color_sensor == nullptr) {
    return fail(ErrorCode::CameraFailed, uri + " has no depth or no colour sensor");
  }
  constexpr int kUsual_hz = 30;
  const auto depth_mode =
      bestMode(*depth_sensor,
               {openni::PIXEL_FORMAT_DEPTH_100_UM, openni::PIXEL_FORMAT_DEPTH_1_MM},
               kUsual_hz);
  const auto color_mode =
      depth_mode ? bestMode(*color_sensor, {openni::PIXEL_FORMAT_RGB888}, depth_mode->getFps())
                 : std::nullopt;
  if (!depth_mode || !color_mode) {
    return fail(ErrorCode::CameraFailed, uri + " has no 16-bit depth or no 24-bit colour mode");
  }
  const bool created = depth.create(device, openni::SENSOR_DEPTH) == openni::STATUS_OK &&
                       color.create(device, openni::SENSOR_COLOR) == openni::STATUS_OK &&
                       depth.setVideoMode(*depth_mode) == openni::STATUS_OK &&
                       color.setVideoMode(*color_mode) == openni::STATUS_OK;
  if (!created) {
    return fail(ErrorCode::CameraFailed, uri + ": " + extendedError());
  }
  // Where a driver mirrors by default, calibration would be of another picture.
  depth.setMirroringEnabled(false);
  color.setMirroringEnabled(false);
  device.setImageRegistrationMode(openni::IMAGE_REGISTRATION_OFF);
  return {};
}

DriverFacts OpenNiCamera::State::driverFacts() {
  DriverFacts driver;
  onOpenNiThread([&] { driver = factsHere(); });
  return driver;
}

DriverFacts OpenNiCamera::State::factsHere() {
  const openni::VideoMode depth_mode = depth.getVideoMode();
  const openni::VideoMode color_mode = color.getVideoMode();
  const openni::DeviceInfo& info = device.getDeviceInfo();
  DriverFacts driver{
      .uri = uri,
      .model = std::string(info.getVendor()) + " " + info.getName(),
      .serial = {},
      .depth_width = depth_mode.getResolutionX(),
      .depth_height = depth_mode.getResolutionY(),
      .color_width = color_mode.getResolutionX(),
      .color_height = color_mode.getResolutionY(),
      .frames_per_s = static_cast<double>(depth_mode.getFps()),
      .depth_field_of_view_rad = static_cast<double>(depth.getHorizontalFieldOfView()),
      .color_field_of_view_rad = static_cast<double>(color.getHorizontalFieldOfView())};
  driver.depth_units_per_m =
      depth_mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM ? 10000.0 : 1000.0;
  std::array<char, 256> serial{};
  int size = static_cast<int>(serial.size());
  if (device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, serial.data(), &size) ==
      openni::STATUS_OK) {
    serial.back() = '\0';
    driver.serial = serial.data();
  }
  return driver;
}

Expected<void> OpenNiCamera::State::startStreams() {
  std::string why;
  bool started = false;
  onOpenNiThread([&] {
    started = color.start() == openni::STATUS_OK && depth.start() == openni::STATUS_OK;
    why = started ? "" : extendedError();
  });
  last_sensor_index = -1;
  last_seen = Clock::now();
  return started ? Expected<void>() : fail(ErrorCode::CameraFailed, uri + ": " + why);
}

void OpenNiCamera::State::stopStreams() {
  onOpenNiThread([&] {
    depth.stop();
    color.stop();
  });
  std::this_thread::sleep_for(kSettle);
}

void OpenNiCamera::State::close() {
  if (!device.isValid()) {
    return;
  }
  stopStreams();
  onOpenNiThread([&] {
    depth.destroy();
    color.destroy();
    device.close();
  });
}

Expected<InfraredImage> OpenNiCamera::State::infraredHere() {
  constexpr auto kMost = milliseconds(2000);
  const auto* sensor = device.getSensorInfo(openni::SENSOR_IR);
  const auto mode = sensor == nullptr
                        ? std::nullopt
                        : bestMode(*sensor,
                                   {openni::PIXEL_FORMAT_GRAY16, openni::PIXEL_FORMAT_GRAY8},
                                   static_cast<int>(facts.camera.frames_per_s));
  openni::VideoStream stream;
  if (!mode || stream.create(device, openni::SENSOR_IR) != openni::STATUS_OK) {
    return fail(ErrorCode::CameraFailed, uri + " gives no infrared pictures");
  }
  stream.setVideoMode(*mode);
  stream.setMirroringEnabled(false);
  color.stop();
  std::optional<SensorImage> image;
  if (stream.start() == openni::STATUS_OK) {
    image = readAny({&stream}, kMost, facts.camera.depth_units_per_m);
    stream.stop();
  }
  std::this_thread::sleep_for(kSettle);
  stream.destroy();
  const bool goes_on = color.start() == openni::STATUS_OK;
  if (!image || !goes_on) {
    return fail(ErrorCode::CameraFailed,
                uri + (image ? ": colour did not start again" : ": no infrared picture came"));
  }
  return std::move(image->infrared);
}

void OpenNiCamera::State::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (!plug->there()) {
      comeBack(stop);
      continue;
    }
    std::optional<SensorImage> image;
    onOpenNiThread([&] {
      image = readAny({&depth, &color}, kWait, facts.camera.depth_units_per_m);
    });
    if (image) {
      take(std::move(*image));
    } else if (Clock::now() - last_seen > kSilence) {
      now = CameraState::Silent;
    }
  }
}

/// Waits until the camera is plugged in again, and goes on with it.
void OpenNiCamera::State::comeBack(const std::stop_token& stop) {
  now = CameraState::Unplugged;
  {
    const std::scoped_lock lock(mutex);
    ++counts.unplugged;
  }
  handOn(true);
  close();
  const auto gone = Clock::now();
  while (!stop.stop_requested()) {
    std::this_thread::sleep_for(kWait);
    if (plug->there() && openDevice() && startStreams()) {
      // Its clock may begin anew; the scan's goes on.
      const auto away = std::chrono::duration_cast<microseconds>(Clock::now() - gone);
      time_offset = std::max(last_time, microseconds{}) + away;
      pairing.emplace(facts.camera.frames_per_s);
      rebase = true;
      return;
    }
  }
}

void OpenNiCamera::State::take(SensorImage image) {
  last_seen = Clock::now();
  now = CameraState::Streaming;
  if (rebase) {
    time_offset -= image.time;
    rebase = false;
  }
  image.time += time_offset;
  const auto fits = [](const auto& picture, const Intrinsics& lens) {
    return picture.width() == lens.width && picture.height() == lens.height;
  };
  if (image.kind == SensorImage::Kind::Depth && fits(image.depth, facts.camera.depth) &&
      image.time > last_time) {
    const int missing = last_sensor_index >= 0 ? image.index - last_sensor_index - 1 : 0;
    last_sensor_index = image.index;
    last_time = image.time;
    pairing->add(image.time, std::move(image.depth));
    const std::scoped_lock lock(mutex);
    counts.dropped += std::max(0, missing);
  } else if (image.kind == SensorImage::Kind::Color && fits(image.color, facts.camera.color)) {
    pairing->add(image.time, std::move(image.color));
  }
  handOn(false);
}

void OpenNiCamera::State::handOn(bool last) {
  while (auto frame = pairing->next(last)) {
    frame->index = frames++;
    {
      const std::scoped_lock lock(mutex);
      ++counts.pairs;
      counts.unpaired += frame->color.width() > 0 ? 0 : 1;
    }
    give(std::move(*frame));
  }
}

Expected<std::unique_ptr<OpenNiCamera>> OpenNiCamera::open(const std::string& uri) {
  auto state = std::make_unique<State>();
  auto library = OpenNiLibrary::hold();
  if (!library) {
    return tl::unexpected(library.error());
  }
  state->library = std::move(*library);
  onOpenNiThread([&] { state->plug = std::make_unique<PlugListener>(); });
  state->uri = uri;
  if (uri.empty()) {
    const auto cameras = listCameras();
    if (!cameras) {
      return tl::unexpected(cameras.error());
    }
    if (cameras->empty()) {
      return fail(ErrorCode::CameraNotFound, "no camera is plugged in");
    }
    state->uri = cameras->front().uri;
  }
  // What is wrong with a recorded scan is better said than "no such camera".
  if (const auto address = parseSimulatedAddress(state->uri)) {
    const auto usable = readCamera(address->scan / "camera.json").and_then([&](const RgbdCamera&) {
      return listFrames(address->scan);
    });
    if (!usable) {
      return tl::unexpected(usable.error());
    }
    auto plain = plainUri(state->uri);
    if (!plain) {
      return tl::unexpected(plain.error());
    }
    state->uri = std::move(*plain);
  }
  if (auto opened = state->openDevice(); !opened) {
    return tl::unexpected(opened.error());
  }
  auto facts = cameraFacts(state->driverFacts());
  if (!facts) {
    return tl::unexpected(facts.error());
  }
  state->facts = std::move(*facts);
  state->plug->watch(state->uri);
  return std::unique_ptr<OpenNiCamera>(new OpenNiCamera(std::move(state)));
}

OpenNiCamera::OpenNiCamera(std::unique_ptr<State> state) : state_(std::move(state)) {}
OpenNiCamera::~OpenNiCamera() = default;

const RgbdCamera& OpenNiCamera::camera() const { return state_->facts.camera; }
const Warnings& OpenNiCamera::warnings() const { return state_->facts.warnings; }
bool OpenNiCamera::describesItself() const { return state_->facts.describes_itself; }

Expected<void> OpenNiCamera::start(std::function<void(RgbdFrame)> take) {
  stop();
  state_->give = std::move(take);
  state_->pairing.emplace(camera().frames_per_s);
  state_->frames = 0;
  state_->last_time = microseconds(-1);
  state_->time_offset = microseconds{};
  {
    const std::scoped_lock lock(state_->mutex);
    state_->counts = {};
  }
  if (auto started = state_->startStreams(); !started) {
    return started;
  }
  state_->now = CameraState::Streaming;
  state_->thread =
      std::jthread([state = state_.get()](const std::stop_token& stop) { state->run(stop); });
  return {};
}

void OpenNiCamera::stop() {
  if (state_->thread.joinable()) {
    state_->thread.request_stop();
    state_->thread.join();
    state_->stopStreams();
    state_->now = CameraState::Stopped;
  }
}

bool OpenNiCamera::hasInfrared() const {
  bool there = false;
  onOpenNiThread([&] { there = state_->device.hasSensor(openni::SENSOR_IR); });
  return there;
}

Expected<InfraredImage> OpenNiCamera::infrared() {
  TARSUS_REQUIRE(state_->thread.joinable(), "the camera runs");
  Expected<InfraredImage> image;
  onOpenNiThread([&] { image = state_->infraredHere(); });
  return image;
}

CameraState OpenNiCamera::state() const { return state_->now; }

CaptureCounts OpenNiCamera::counts() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->counts;
}

}  // namespace tarsus
