#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace tarsus {

/// One surface point as one image shows it [grey levels].
struct ExposureSample {
  std::uint32_t point = 0;
  std::uint32_t image = 0;
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
};

/// How an image shows colours: gain x colour + bias, each channel on its own.
struct ColorGain {
  Eigen::Vector3f gain = Eigen::Vector3f::Ones();
  Eigen::Vector3f bias = Eigen::Vector3f::Zero();  ///< [grey levels]

  /// The image's colour as all images agree on it [grey levels].
  [[nodiscard]] Eigen::Vector3f leveled(const Eigen::Vector3f& color) const {
    return (color - bias).cwiseQuotient(gain);
  }
};

/// Gain of each image and channel such that the levelled images agree on the points they share:
/// medians of the log ratios of each pair of images, joined by least squares. Where a bias lowers
/// what is left clearly, gain and bias are solved for together, odd samples (highlights) left out.
/// Of images that are joined by shared points the median gain is 1 and the median bias 0, so that
/// levelling does not shift the colours as a whole; an image that shares nothing stays as it is.
/// @param samples  sorted by point
/// @return image_count entries; gain in [0.5, 2], bias within 30 grey levels
[[nodiscard]] std::vector<ColorGain> solveGains(std::span<const ExposureSample> samples,
                                                int image_count);

}  // namespace tarsus
