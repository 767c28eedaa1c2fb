#pragma once

#include "measurement/phantom/phantom_design.h"

#include <algorithm>
#include <string>
#include <vector>

namespace tarsus {

/// How far a control distance may be off: 0.2 %, less than half of the limit on scale, or a
/// layer's rounding.
[[nodiscard]] inline double controlTolerance_mm(double distance_mm) {
  return std::max(0.1, 0.002 * distance_mm);
}
inline constexpr double kLayerHeight_mm = 0.12;

/// The text of PHANTOM.txt: how to print, check, scan and verify.
[[nodiscard]] std::string phantomGuide(const std::vector<PhantomDesign>& designs);

}  // namespace tarsus
