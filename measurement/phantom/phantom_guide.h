#pragma once

#include "measurement/phantom/phantom_design.h"

#include <string>
#include <vector>

namespace tarsus {

/// A print whose control distances are off by more than this share is not used: less than half of
/// the limit on scale.
inline constexpr double kControlTolerance = 0.002;
inline constexpr double kLayerHeight_mm = 0.12;

/// The text of PHANTOM.txt: how to print, check, scan and verify.
[[nodiscard]] std::string phantomGuide(const std::vector<PhantomDesign>& designs);

}  // namespace tarsus
