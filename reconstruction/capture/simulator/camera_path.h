#pragma once

#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/scene/frame.h"

namespace tarsus {

inline constexpr double kMotionSeconds = 20.0;  ///< the paper's scan
inline constexpr double kSensorFps = 30.0;

/// The simulated sensor: 640x480, pinhole, 0.125 mm depth steps.
[[nodiscard]] RgbdCamera simulatedCamera(const SimulatorOptions& options);

/// Pose of the depth camera at a time of the 20 s motion; in the room, which is the foot frame
/// (foot_shape.h) [mm] at a first visit, for a foot of standard length. Rig: an arc in the vertical
/// plane while the camera swings from side to side, as in the paper. Loop: once round the foot,
/// ends where it began. Quick: a hand, with pauses and hurry. For the lateral ulcer all of them
/// look from farther to that side.
[[nodiscard]] RigidTransform roomFromCamera(const SimulatorOptions& options, double time_s);

/// When frame `index` is taken [s].
[[nodiscard]] double frameTime(const SimulatorOptions& options, int index);

}  // namespace tarsus
