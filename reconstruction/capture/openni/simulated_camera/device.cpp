#include "reconstruction/capture/openni/simulated_camera/device.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace tarsus {
namespace {

/// A property's value; the size asked for must be that of its type.
template <typename Value>
OniStatus give(Value value, void* data, int* size) {
  if (*size != static_cast<int>(sizeof value)) {
    return ONI_STATUS_BAD_PARAMETER;
  }
  std::memcpy(data, &value, sizeof value);
  return ONI_STATUS_OK;
}

int bytesOfPixel(OniSensorType sensor) { return sensor == ONI_SENSOR_COLOR ? 3 : 2; }

const void* dataOf(const SensorImages& images, OniSensorType sensor) {
  switch (sensor) {
    case ONI_SENSOR_DEPTH:
      return images.depth != nullptr ? images.depth->data() : nullptr;
    case ONI_SENSOR_IR:
      return images.infrared != nullptr ? images.infrared->data() : nullptr;
    default:
      return images.color != nullptr ? static_cast<const void*>(images.color->data()) : nullptr;
  }
}

float fieldOfView(int pixels, double focal_px) {
  return static_cast<float>(2.0 * std::atan(0.5 * pixels / focal_px));
}

}  // namespace

SimulatedStream::SimulatedStream(SimulatedDevice& device, OniSensorType sensor)
    : device_(device), sensor_(sensor), mode_(device.modeOf(sensor)) {}

OniStatus SimulatedStream::start() {
  running_ = true;
  device_.streamsChanged();
  return ONI_STATUS_OK;
}

void SimulatedStream::stop() {
  {
    const std::scoped_lock lock(showing_);
    running_ = false;
  }
  device_.streamsChanged();
}

OniBool SimulatedStream::isPropertySupported(int property) {
  switch (property) {
    case ONI_STREAM_PROPERTY_CROPPING:  // without it recordings play back no frame
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
    case ONI_STREAM_PROPERTY_STRIDE:
    case ONI_STREAM_PROPERTY_MIRRORING:
      return TRUE;
    case ONI_STREAM_PROPERTY_MAX_VALUE:
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return sensor_ == ONI_SENSOR_DEPTH ? TRUE : FALSE;
    default:
      return FALSE;
  }
}

OniStatus SimulatedStream::getProperty(int property, void* data, int* size) {
  const Intrinsics& lens =
      sensor_ == ONI_SENSOR_COLOR ? device_.camera().color : device_.camera().depth;
  switch (property) {
    case ONI_STREAM_PROPERTY_CROPPING:
      return give(OniCropping{FALSE, 0, 0, mode_.resolutionX, mode_.resolutionY}, data, size);
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return give(mode_, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return give(fieldOfView(lens.width, lens.fx_px), data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return give(fieldOfView(lens.height, lens.fy_px), data, size);
    case ONI_STREAM_PROPERTY_STRIDE:
      return give(mode_.resolutionX * bytesOfPixel(sensor_), data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return give(static_cast<OniBool>(FALSE), data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return sensor_ == ONI_SENSOR_DEPTH ? give(65535, data, size) : ONI_STATUS_NOT_SUPPORTED;
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return sensor_ == ONI_SENSOR_DEPTH ? give(0, data, size) : ONI_STATUS_NOT_SUPPORTED;
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus SimulatedStream::setProperty(int property, const void* data, int size) {
  if (property == ONI_STREAM_PROPERTY_VIDEO_MODE && size == static_cast<int>(sizeof mode_)) {
    return std::memcmp(data, &mode_, sizeof mode_) == 0 ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  if (property == ONI_STREAM_PROPERTY_MIRRORING && size == static_cast<int>(sizeof(OniBool))) {
    return *static_cast<const OniBool*>(data) == FALSE ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

void SimulatedStream::show(const SensorImages& images) {
  const std::scoped_lock lock(showing_);
  const void* data = dataOf(images, sensor_);
  if (!running_ || data == nullptr) {
    return;
  }
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) {
    return;
  }
  frame->sensorType = sensor_;
  frame->timestamp = static_cast<std::uint64_t>(images.timestamp.count());
  frame->frameIndex = images.index;
  frame->width = mode_.resolutionX;
  frame->height = mode_.resolutionY;
  frame->videoMode = mode_;
  frame->croppingEnabled = FALSE;
  frame->cropOriginX = 0;
  frame->cropOriginY = 0;
  frame->stride = mode_.resolutionX * bytesOfPixel(sensor_);
  const int bytes = frame->stride * mode_.resolutionY;
  std::memcpy(frame->data, data, static_cast<std::size_t>(std::min(bytes, frame->dataSize)));
  frame->dataSize = bytes;
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

SimulatedDevice::SimulatedDevice(std::unique_ptr<FramePlayer> player,
                                 std::string serial,
                                 std::function<void()> when_first_started)
    : player_(std::move(player)),
      serial_(std::move(serial)),
      when_first_started_(std::move(when_first_started)) {
  const RgbdCamera& camera = player_->camera();
  const int fps = std::max(1, static_cast<int>(std::lround(camera.frames_per_s)));
  // The SR300's driver calls its steps of 0.125 mm a millimetre; here too the format says nothing.
  modes_ = {OniVideoMode{ONI_PIXEL_FORMAT_DEPTH_1_MM, camera.depth.width, camera.depth.height, fps},
            OniVideoMode{ONI_PIXEL_FORMAT_RGB888, camera.color.width, camera.color.height, fps},
            OniVideoMode{ONI_PIXEL_FORMAT_GRAY16, camera.depth.width, camera.depth.height, fps}};
  sensors_ = {OniSensorInfo{ONI_SENSOR_DEPTH, 1, modes_.data()},
              OniSensorInfo{ONI_SENSOR_COLOR, 1, modes_.data() + 1},
              OniSensorInfo{ONI_SENSOR_IR, 1, modes_.data() + 2}};
}

SimulatedDevice::~SimulatedDevice() { player_->stop(); }

OniStatus SimulatedDevice::getSensorInfoList(OniSensorInfo** sensors, int* count) {
  *sensors = sensors_.data();
  *count = player_->hasInfrared() ? 3 : 2;
  return ONI_STATUS_OK;
}

oni::driver::StreamBase* SimulatedDevice::createStream(OniSensorType sensor) {
  const bool there = sensor == ONI_SENSOR_DEPTH || sensor == ONI_SENSOR_COLOR ||
                     (sensor == ONI_SENSOR_IR && player_->hasInfrared());
  if (!there) {
    return nullptr;
  }
  const std::scoped_lock lock(list_);
  return streams_.emplace_back(std::make_shared<SimulatedStream>(*this, sensor)).get();
}

void SimulatedDevice::destroyStream(oni::driver::StreamBase* stream) {
  const std::scoped_lock lock(list_);
  std::erase_if(streams_, [&](const auto& own) { return own.get() == stream; });
}

OniBool SimulatedDevice::isPropertySupported(int property) {
  return property == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ||
                 property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION
             ? TRUE
             : FALSE;
}

OniStatus SimulatedDevice::getProperty(int property, void* data, int* size) {
  if (property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) {
    return give(ONI_IMAGE_REGISTRATION_OFF, data, size);
  }
  if (property != ONI_DEVICE_PROPERTY_SERIAL_NUMBER || *size <= static_cast<int>(serial_.size())) {
    return ONI_STATUS_NOT_SUPPORTED;
  }
  std::memcpy(data, serial_.c_str(), serial_.size() + 1);
  *size = static_cast<int>(serial_.size() + 1);
  return ONI_STATUS_OK;
}

OniVideoMode SimulatedDevice::modeOf(OniSensorType sensor) const {
  for (const OniSensorInfo& info : sensors_) {
    if (info.sensorType == sensor) {
      return *info.pSupportedVideoModes;
    }
  }
  return modes_.front();
}

std::vector<std::shared_ptr<SimulatedStream>> SimulatedDevice::streams() {
  const std::scoped_lock lock(list_);
  return streams_;
}

void SimulatedDevice::streamsChanged() {
  const std::scoped_lock lock(control_);
  const auto all = streams();
  const bool wanted = std::ranges::any_of(all, [](const auto& s) { return s->running(); });
  player_->wantInfrared(std::ranges::any_of(
      all, [](const auto& s) { return s->running() && s->sensor() == ONI_SENSOR_IR; }));
  if (wanted && !playing_) {
    player_->start([this](const SensorImages& images) {
      for (const auto& stream : streams()) {
        stream->show(images);
      }
    });
    if (const auto tell = std::exchange(when_first_started_, nullptr)) {
      tell();
    }
  } else if (!wanted && playing_) {
    player_->stop();
  }
  playing_ = wanted;
}

}  // namespace tarsus
