#pragma once

#include "measurement/wound/reference_skin.h"

#include <Eigen/Core>

#include <functional>
#include <span>

namespace tarsus::test {

/// The rival: a soft bi-Laplacian height field on a 1 mm grid over the plane z = 0,
///   min integral |D^2 h|^2 length^4 + sum area (z - h)^2.
/// Interpolates less the longer the length.
[[nodiscard]] std::function<double(const Eigen::Vector2d&)> thinPlate(
    std::span<const SkinSample> samples, double length_mm);

}  // namespace tarsus::test
