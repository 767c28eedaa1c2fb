#pragma once

#include "reconstruction/scene/image.h"

#include <Eigen/Core>

namespace tarsus {

/// Whether sampleColor and sampleIntensity may be asked for this pixel.
[[nodiscard]] inline bool insideForSampling(int width, int height, float u, float v) {
  return u >= 0.0F && v >= 0.0F && u < static_cast<float>(width - 1) &&
         v < static_cast<float>(height - 1);
}

/// Colour at (u, v) between pixels, bilinear on the sRGB values as stored [grey levels].
///
/// Plain sRGB, not linear light: an exposure factor stays a factor under the power law of sRGB, the
/// views that are averaged agree within a few levels, where both means are the same to a fraction
/// of a level, and the photometric error is defined in the levels of the file.
[[nodiscard]] Eigen::Vector3f sampleColor(const ColorImage& image, float u, float v);

/// Rec. 601 luminance of an sRGB colour [grey levels].
[[nodiscard]] inline float intensityOf(const Eigen::Vector3f& color) {
  return 0.299F * color.x() + 0.587F * color.y() + 0.114F * color.z();
}

/// Luminance and its derivatives over the image, for alignment of images.
struct IntensityGradient {
  Image<float> intensity;  ///< [grey levels]
  Image<float> du;         ///< [grey levels per px]
  Image<float> dv;         ///< [grey levels per px]
};

/// Sobel derivatives divided by 8, so that they are true slopes per pixel: without it each
/// Gauss-Newton step on them is one eighth of what it should be.
[[nodiscard]] IntensityGradient intensityGradient(const ColorImage& image);

}  // namespace tarsus
