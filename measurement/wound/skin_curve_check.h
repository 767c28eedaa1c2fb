#pragma once

#include "measurement/wound/reference_skin.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace tarsus {

/// A stretch of the skin curve where the skin just outside it is not what the reference skin takes
/// it for.
struct UnevenSkin {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  ///< scan frame, on the skin beside the curve
  double slope = 0.0;      ///< rise with the way outwards; negative: falls, as from a callus
  double raised_mm = 0.0;  ///< above the reference skin
};

/// Where the skin curve runs over a slope or on a height, as that of a callus, which then lifts
/// the reference skin: a line through the heights of the 3 mm of skin outside it, in each eighth
/// around the wound, is steeper than 7 degrees, or higher than 0.3 mm, and than noise could make
/// it (3 standard deviations).
/// @param samples  of the skin outside the curve
[[nodiscard]] std::vector<UnevenSkin> unevenAlongSkinCurve(std::span<const SkinSample> samples,
                                                           const ReferenceSkin& skin,
                                                           double correlation_area_mm2);

}  // namespace tarsus
