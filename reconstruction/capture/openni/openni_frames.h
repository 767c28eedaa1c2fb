#pragma once

#include "reconstruction/scene/frame.h"

#include <chrono>
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

/// One image as a stream gave it.
struct SensorImage {
  bool is_depth = false;
  int index = 0;  ///< the sensor's own count
  std::chrono::microseconds time{};
  DepthImage depth;
  ColorImage color;
};

/// The next image of any of the streams; on OpenNI's thread (openni_library.h).
/// @return  nothing where none came in time
[[nodiscard]] std::optional<SensorImage> readAny(std::vector<openni::VideoStream*> streams,
                                                 std::chrono::milliseconds most,
                                                 double units_per_m);

}  // namespace tarsus
