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

/// Gain of each image and channel such that image / gain agree on the points they share: medians of
/// the log ratios of each pair of images, joined by least squares. The median of the gains is 1, so
/// that levelling does not shift the colours as a whole.
/// @param samples  sorted by point
/// @return image_count factors per channel, in [0.5, 2]
[[nodiscard]] std::vector<Eigen::Vector3f> solveGains(std::span<const ExposureSample> samples,
                                                      int image_count);

}  // namespace tarsus
