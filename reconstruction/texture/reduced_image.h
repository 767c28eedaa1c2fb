#pragma once

#include "reconstruction/scene/frame.h"

namespace tarsus {

/// 1/factor in size by means over areas, then smoothed by (1 2 1) / 4 both ways: noise of single
/// pixels leaves the slopes, and every size has the same smoothness in its own pixels.
[[nodiscard]] Image<float> reduced(const Image<float>& image, int factor);

/// The camera that would have taken the reduced image.
[[nodiscard]] Intrinsics reduced(const Intrinsics& camera, int factor);

}  // namespace tarsus
