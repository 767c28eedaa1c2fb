#pragma once

#include "reconstruction/base/error.h"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace tarsus {

/// Where a rig's drive stands.
struct RigPosition {
  double place = 0.0;  ///< by its encoder: degrees of an arm, or mm of a slide
  bool moving = false;
};

/// A motor that carries the camera around the foot on a known path. A clinic's own drive needs only
/// a class of this kind, or a box that speaks the lines of serial_rig (README.md).
class Rig {
 public:
  Rig() = default;
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;
  Rig(Rig&&) = delete;
  Rig& operator=(Rig&&) = delete;
  virtual ~Rig() = default;

  /// Begins to move there and returns; an earlier move ends.
  /// @param speed  per second, greater than 0
  /// @errors RigFailed, BadOption (a place it cannot reach)
  [[nodiscard]] virtual Expected<void> move(double place, double speed) = 0;
  /// @errors RigFailed
  [[nodiscard]] virtual Expected<RigPosition> position() = 0;
  /// At once, wherever it is.
  /// @errors RigFailed
  [[nodiscard]] virtual Expected<void> stop() = 0;
};

/// A rig on a serial line: 115200 baud, 8N1, the lines of README.md.
/// @param device  /dev/ttyUSB0 and the like
/// @param answer  the longest that an answer may take
/// @errors RigFailed (no such device, or no Tarsus rig answers there)
[[nodiscard]] Expected<std::unique_ptr<Rig>> openSerialRig(
    const std::string& device, std::chrono::milliseconds answer = std::chrono::milliseconds(500));

/// A rig without hardware: moves at the speed asked for, between two ends, by a clock that is told
/// what time it is.
/// @param seconds_now  grows; called at each question
[[nodiscard]] std::unique_ptr<Rig> makeSimulatedRig(double first_place,
                                                    double last_place,
                                                    std::function<double()> seconds_now);

}  // namespace tarsus
