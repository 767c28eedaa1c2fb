#pragma once

#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/simulator/ulcer.h"

#include <vector>

namespace tarsus {

/// The ulcers of each simulated foot.
[[nodiscard]] std::vector<UlcerDesign> ulcerDesigns(FootCase foot);

}  // namespace tarsus
