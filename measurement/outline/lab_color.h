#pragma once

#include "reconstruction/scene/image.h"

#include <Eigen/Core>

namespace tarsus {

/// L*, a*, b* of an sRGB colour, white point D65: distances are about those that an eye sees.
/// Source: IEC 61966-2-1 (sRGB), CIE 15 (CIELAB).
[[nodiscard]] Eigen::Vector3d labOf(Rgb8 color);
/// Light of a stored colour, each channel in [0, 1].
[[nodiscard]] Eigen::Vector3d linearOf(Rgb8 color);
[[nodiscard]] Eigen::Vector3d labOfLinear(const Eigen::Vector3d& linear_rgb);

}  // namespace tarsus
