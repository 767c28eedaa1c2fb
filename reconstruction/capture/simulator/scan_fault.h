#pragma once

#include "reconstruction/capture/simulator/renderer.h"
#include "reconstruction/capture/simulator/simulator.h"

namespace tarsus {

/// Whether the fault changes what frame `index` of `frames` shows, or takes the frame away. Jump
/// and Rest change where the camera stands, not what it does there: never.
[[nodiscard]] bool strikes(ScanFault fault, int index, int frames);

/// Frames from which the camera of ScanFault::Jump stands elsewhere: at 1/4, 1/2, 3/4 of the scan.
[[nodiscard]] std::vector<int> jumpFrames(int frames);
inline constexpr double kJumpMm = 20.0;  ///< to the camera's right, each time

/// How many times too large the depths of ScanFault::Unit are: 0.125 mm taken for 1 mm.
inline constexpr float kUnitTooLarge = 8.0F;

/// A hand flat before the camera at 150 mm, and nothing else.
[[nodiscard]] IdealView handBefore(const Intrinsics& camera);

/// Takes discs of 3-12 px out of the image until 30 % of its pixels hold nothing more. Depends on
/// seed and frame alone, also where the sensor is free of noise.
[[nodiscard]] DepthImage withHoles(DepthImage depth, std::uint64_t seed, int frame);

/// Left and right exchanged.
[[nodiscard]] ColorImage mirrored(ColorImage color);

}  // namespace tarsus
