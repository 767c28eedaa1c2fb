#pragma once

#include "reconstruction/capture/simulator/color.h"
#include "reconstruction/capture/simulator/ulcer.h"

namespace tarsus {

/// Bed and wall of an ulcer: granulation, slough, necrosis.
/// @param p  on the intact skin inside the rim
[[nodiscard]] Color bedColor(const Ulcer& ulcer, const Eigen::Vector3d& p);

/// What the ulcer does to the skin around it: pink margin, maceration, callus, redness, pen marks.
[[nodiscard]] Color marginColor(const Ulcer& ulcer, const Eigen::Vector3d& p, const Color& skin);

}  // namespace tarsus
