#pragma once

#include "reconstruction/scene/frame.h"

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace openni {  // NOLINT(readability-identifier-naming): not ours
class VideoStream;
}

namespace tarsus {

/// Joins depth and colour images that were taken together: nearest in time, within half a period.
/// Depth goes on alone where no colour came; frames leave in the order of time.
class FramePairing {
 public:
  explicit FramePairing(double frames_per_s);
  void add(std::chrono::microseconds time, DepthImage depth);
  void add(std::chrono::microseconds time, ColorImage color);
  /// The next frame that is decided, if any; without index. `last`: nothing more will come.
  [[nodiscard]] std::optional<RgbdFrame> next(bool last = false);

 private:
  struct Color {
    std::chrono::microseconds time{};
    ColorImage image;
  };
  std::chrono::microseconds reach_;
  std::deque<RgbdFrame> depth_;
  std::deque<Color> color_;
};

/// Grey levels of an infrared sensor.
using InfraredImage = Image<std::uint16_t>;

/// One image as a stream gave it.
struct SensorImage {
  enum class Kind { Depth, Color, Infrared };
  Kind kind = Kind::Depth;
  int index = 0;  ///< the sensor's own count
  std::chrono::microseconds time{};
  DepthImage depth;
  ColorImage color;
  InfraredImage infrared;
};

/// The next image of any of the streams; on OpenNI's thread (openni_library.h).
/// @return  nothing where none came in time
[[nodiscard]] std::optional<SensorImage> readAny(std::vector<openni::VideoStream*> streams,
                                                 std::chrono::milliseconds most,
                                                 double units_per_m);

}  // namespace tarsus
