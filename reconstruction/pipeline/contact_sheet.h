#pragma once

#include "reconstruction/texture/keyframes.h"

#include <span>

namespace tarsus {

struct ContactSheetOptions {
  int columns = 6;
  int picture_width_px = 240;
  int gap_px = 6;
  Rgb8 background{255, 255, 255};
};

/// All keyframes in one small picture, row by row in their order; empty where there is none.
[[nodiscard]] ColorImage contactSheet(std::span<const Keyframe> keyframes,
                                      const ContactSheetOptions& options = {});

}  // namespace tarsus
