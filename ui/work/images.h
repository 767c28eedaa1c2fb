#pragma once

#include "reconstruction/scene/image.h"

#include <QImage>

namespace tarsus {

[[nodiscard]] QImage imageOf(const ColorImage& image);

/// Depth as the scan screen shows it: near bright yellow, far dark blue (cividis, which the colour
/// blind read too), nothing black.
[[nodiscard]] QImage depthPicture(const DepthImage& depth_mm, double near_mm, double far_mm);
/// A colour of that scale; 0 near, 1 far.
[[nodiscard]] QColor depthColor(double share);

}  // namespace tarsus
