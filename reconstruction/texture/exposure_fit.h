#pragma once

#include "reconstruction/texture/exposure.h"

#include <span>
#include <vector>

namespace tarsus {

/// How one image shows one channel: exp(log_gain) x colour + bias.
struct Response {
  double log_gain = 0.0;
  double bias = 0.0;  ///< [grey levels]
};

/// Below, noise and rounding rule a level; above, the sensor may have clipped it.
[[nodiscard]] inline bool isUsableLevel(float level) { return level >= 8.0F && level <= 245.0F; }

/// Moves each group of images so that its median gain is 1 and its median bias (in units of the
/// levelled colours) 0, which leaves their agreement as it is.
/// @param group_of_image  equal for images that are joined by shared points
void anchorAtMedian(std::span<const int> group_of_image, std::span<Response> responses);

/// Gain and bias of all images together from the points they share, by Gauss-Newton on
/// level - (gain x colour + bias) with Tukey's weights, the colours of the points eliminated. (In
/// levelled colours instead, the least error would be a gain without end that makes all one grey.)
/// Tied weakly to the start, biases to 0.
/// @param samples  sorted by point
/// @return  the start where biases do not lower what is left clearly
[[nodiscard]] std::vector<Response> fitBiases(std::span<const ExposureSample> samples,
                                              int channel,
                                              std::span<const int> group_of_image,
                                              const std::vector<Response>& start);

}  // namespace tarsus
