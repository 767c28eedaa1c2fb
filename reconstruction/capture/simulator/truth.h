#pragma once

#include "reconstruction/capture/simulator/carving.h"
#include "reconstruction/capture/simulator/simulator.h"

namespace tarsus {

/// Measures ulcer `which` on the two dense meshes: areas and volume once by exact sums over the
/// faces inside the rim, once by a fine grid of rays along the ulcer's axis; the lengths from the
/// rim. Definitions: clinical.md section 2.
/// @return in the foot frame [mm]
[[nodiscard]] WoundTruth measureTruth(const IntactFoot& foot, const CarvedFoot& carved, int which);

}  // namespace tarsus
