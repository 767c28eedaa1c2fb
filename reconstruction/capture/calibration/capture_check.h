#pragma once

#include "reconstruction/capture/calibration/calibration.h"

namespace tarsus {

struct Size {
  int width = 0;
  int height = 0;
  bool operator==(const Size&) const = default;
};

/// Which images a capture has, and how large they are.
struct Sizes {
  Size color;
  Size depth;
  bool infrared = false;
  bool depth_images = false;
};

/// @errors CalibrationFailed (no colour, sizes that change or disagree), CameraFactsMissing
[[nodiscard]] Expected<Sizes> sizesOf(const CalibrationCapture& capture);

/// @errors BadOption
[[nodiscard]] Expected<void> checkOptions(const CalibrationOptions& options);

}  // namespace tarsus
