#pragma once

#include "reconstruction/scene/image.h"

#include <Eigen/Core>

namespace tarsus {

/// sRGB as numbers in [0, 255], for mixing.
using Color = Eigen::Vector3d;

[[nodiscard]] inline Color mix(const Color& from, const Color& to, double share) {
  return from + share * (to - from);
}

[[nodiscard]] inline Rgb8 toRgb8(const Color& c) {
  const Eigen::Vector3d r = (c.array() + 0.5).min(255.0).max(0.0);
  return {static_cast<std::uint8_t>(r.x()),
          static_cast<std::uint8_t>(r.y()),
          static_cast<std::uint8_t>(r.z())};
}

}  // namespace tarsus
