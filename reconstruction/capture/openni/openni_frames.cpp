#include "reconstruction/capture/openni/openni_frames.h"

#include <OpenNI.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace tarsus {
namespace {

/// Images that wait for their partner, at most: at 30 Hz a tenth of a second.
constexpr std::size_t kMostWaiting = 4;

template <typename Pixel>
const Pixel* rowOf(const openni::VideoFrameRef& frame, int v) {
  const auto* bytes = static_cast<const std::uint8_t*>(frame.getData());
  return reinterpret_cast<const Pixel*>(bytes +
                                        static_cast<std::ptrdiff_t>(v) * frame.getStrideInBytes());
}

/// z [mm] by the camera's unit, to the bit as readDepthImage gives the same numbers.
DepthImage depthOf(const openni::VideoFrameRef& frame, double units_per_m) {
  DepthImage depth(frame.getWidth(), frame.getHeight());
  const double mm_per_unit = 1000.0 / units_per_m;
  for (int v = 0; v < depth.height(); ++v) {
    const auto* row = rowOf<std::uint16_t>(frame, v);
    for (int u = 0; u < depth.width(); ++u) {
      depth.at(u, v) = static_cast<float>(row[u] * mm_per_unit);
    }
  }
  return depth;
}

ColorImage colorOf(const openni::VideoFrameRef& frame) {
  ColorImage color(frame.getWidth(), frame.getHeight());
  for (int v = 0; v < color.height(); ++v) {
    const auto* row = rowOf<openni::RGB888Pixel>(frame, v);
    for (int u = 0; u < color.width(); ++u) {
      color.at(u, v) = {.r = row[u].r, .g = row[u].g, .b = row[u].b};
    }
  }
  return color;
}

/// 8 or 16 bits.
InfraredImage infraredOf(const openni::VideoFrameRef& frame) {
  InfraredImage infrared(frame.getWidth(), frame.getHeight());
  const bool deep = frame.getVideoMode().getPixelFormat() == openni::PIXEL_FORMAT_GRAY16;
  for (int v = 0; v < infrared.height(); ++v) {
    for (int u = 0; u < infrared.width(); ++u) {
      infrared.at(u, v) =
          deep ? rowOf<std::uint16_t>(frame, v)[u] : rowOf<std::uint8_t>(frame, v)[u];
    }
  }
  return infrared;
}

SensorImage::Kind kindOf(openni::SensorType sensor) {
  switch (sensor) {
    case openni::SENSOR_DEPTH:
      return SensorImage::Kind::Depth;
    case openni::SENSOR_IR:
      return SensorImage::Kind::Infrared;
    default:
      return SensorImage::Kind::Color;
  }
}

}  // namespace

FramePairing::FramePairing(double frames_per_s)
    : reach_(std::lround(0.5e6 / std::max(1.0, frames_per_s))) {}

void FramePairing::add(std::chrono::microseconds time, DepthImage depth) {
  depth_.push_back({.timestamp = time, .depth = std::move(depth), .color = {}});
}

void FramePairing::add(std::chrono::microseconds time, ColorImage color) {
  color_.push_back({.time = time, .image = std::move(color)});
  if (color_.size() > kMostWaiting) {
    color_.pop_front();
  }
}

std::optional<RgbdFrame> FramePairing::next(bool last) {
  if (depth_.empty()) {
    return std::nullopt;
  }
  const auto time = depth_.front().timestamp;
  // A colour of the same time or later is the nearest that will come.
  const bool decided =
      last || depth_.size() > kMostWaiting || (!color_.empty() && color_.back().time >= time);
  if (!decided) {
    return std::nullopt;
  }
  RgbdFrame frame = std::move(depth_.front());
  depth_.pop_front();
  const auto away = [&](const Color& c) { return std::abs((c.time - time).count()); };
  const auto nearest = std::ranges::min_element(color_, {}, away);
  if (nearest != color_.end() && away(*nearest) <= reach_.count()) {
    frame.color = std::move(nearest->image);
    color_.erase(color_.begin(), nearest + 1);
  }
  return frame;
}

std::optional<SensorImage> readAny(std::vector<openni::VideoStream*> streams,
                                   std::chrono::milliseconds most,
                                   double units_per_m) {
  int ready = -1;
  openni::VideoFrameRef frame;
  const bool got =
      !streams.empty() &&
      openni::OpenNI::waitForAnyStream(streams.data(),
                                       static_cast<int>(streams.size()),
                                       &ready,
                                       static_cast<int>(most.count())) == openni::STATUS_OK &&
      ready >= 0 &&
      streams[static_cast<std::size_t>(ready)]->readFrame(&frame) == openni::STATUS_OK &&
      frame.isValid();
  if (!got) {
    return std::nullopt;
  }
  SensorImage image{
      .kind = kindOf(frame.getSensorType()),
      .index = frame.getFrameIndex(),
      .time = std::chrono::microseconds(static_cast<std::int64_t>(frame.getTimestamp())),
      .depth = {},
      .color = {},
      .infrared = {}};
  switch (image.kind) {
    case SensorImage::Kind::Depth:
      image.depth = depthOf(frame, units_per_m);
      break;
    case SensorImage::Kind::Infrared:
      image.infrared = infraredOf(frame);
      break;
    case SensorImage::Kind::Color:
      image.color = colorOf(frame);
      break;
  }
  return image;
}

}  // namespace tarsus
