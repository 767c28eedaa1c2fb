#pragma once

#include "reconstruction/scene/image.h"
#include "reconstruction/texture/exposure.h"

#include <Eigen/Core>

namespace tarsus {

/// Whether sampleColor and sampleIntensity may be asked for this pixel.
[[nodiscard]] inline bool insideForSampling(int width, int height, float u, float v) {
  return u >= 0.0F && v >= 0.0F && u < static_cast<float>(width - 1) &&
         v < static_cast<float>(height - 1);
}

[[nodiscard]] inline Eigen::Vector3f colorVector(Rgb8 c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

/// Colour at (u, v) between pixels, bilinear on the sRGB values as stored [grey levels].
///
/// Plain sRGB, not linear light: an exposure factor stays a factor under the power law of sRGB, the
/// views that are averaged agree within a few levels, where both means are the same to a fraction
/// of a level, and the photometric error is defined in the levels of the file.
[[nodiscard]] Eigen::Vector3f sampleColor(const ColorImage& image, float u, float v);

/// Colour between pixels by Catmull-Rom splines [grey levels]: keeps three quarters of what
/// bilinear sampling loses of fine detail. At pixel centres exactly the pixel.
/// Source: Keys, IEEE Trans. ASSP 29(6), 1981.
[[nodiscard]] Eigen::Vector3f sampleColorBicubic(const ColorImage& image, float u, float v);

/// Rec. 601 luminance of an sRGB colour [grey levels].
[[nodiscard]] inline float intensityOf(const Eigen::Vector3f& color) {
  return 0.299F * color.x() + 0.587F * color.y() + 0.114F * color.z();
}

/// The luminance of each pixel, exposure levelled [grey levels].
[[nodiscard]] Image<float> intensityImage(const ColorImage& image, const ColorGain& gain);

}  // namespace tarsus
