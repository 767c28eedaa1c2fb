#pragma once

#include "reconstruction/scene/frame.h"

namespace tarsus {

/// What the choice of keyframes knows of a picture, so that the picture itself need not be kept.
struct PictureQuality {
  int frame_index = 0;  ///< RgbdFrame::index
  std::chrono::microseconds timestamp{};
  double blur = 0.0;        ///< of blurMeasure
  double brightness = 0.0;  ///< mean luminance [grey levels]
};

/// Perceptual blur of an image. Source: Crete et al., SPIE 6492, 2007.
/// @return 0 sharp to 1 blurred
[[nodiscard]] double blurMeasure(const ColorImage& image);

/// @param frame  with colour
[[nodiscard]] PictureQuality assessPicture(const RgbdFrame& frame);

}  // namespace tarsus
