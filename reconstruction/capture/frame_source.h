#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <memory>
#include <optional>
#include <vector>

namespace tarsus {

/// Where frames come from: a camera, a recording, or a synthetic foot. Pull only, one thread.
/// Depth leaves in mm and undistorted, colour undistorted: from here on cameras are pinholes.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  FrameSource(FrameSource&&) = delete;
  FrameSource& operator=(FrameSource&&) = delete;
  virtual ~FrameSource() = default;

  [[nodiscard]] virtual const RgbdCamera& camera() const = 0;
  /// How many frames there will be at the most, where that is known beforehand.
  [[nodiscard]] virtual std::optional<int> frameCount() const = 0;
  /// Blocks for the next frame; an empty optional is the regular end of the scan. A frame that
  /// cannot be read is skipped and leaves a warning.
  [[nodiscard]] virtual Expected<std::optional<RgbdFrame>> next() = 0;
  /// What was skipped or doubtful so far.
  [[nodiscard]] virtual const Warnings& warnings() const = 0;
};

/// What the reader of frames wants; decoding colour costs half of a frame's time.
struct FrameContent {
  bool color = true;
  int every_nth = 1;  ///< 2: every second frame
  /// Only these of them (RgbdFrame::index, ascending). A source that cannot leap may give others
  /// too.
  std::optional<std::vector<int>> only = std::nullopt;
};

}  // namespace tarsus
