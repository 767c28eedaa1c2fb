#pragma once

#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/simulator/ulcer.h"
#include "reconstruction/scene/frame.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tarsus {

/// How patient, room and nurse differ from one visit to another.
struct VisitPose {
  RigidTransform room_from_foot =
      RigidTransform::Identity();  ///< the foot, turned on its bench [mm]
  double toe_bend_rad = 0.0;       ///< of all toes about their roots, positive towards the sole
  double start_share = 0.0;        ///< of the camera's motion: where it begins
  double camera_roll_rad = 0.0;    ///< as it is held
  std::array<double, 3> light{1.0, 1.0, 1.0};  ///< red, green, blue against the first visit
};

/// Drawn from a number: the foot turned by up to 10 degrees about each axis and moved by 15 mm,
/// toes bent by -0.15 to 0.3 rad, another start of the camera (30 degrees aside), rolled by up to
/// 12 degrees, light 20 % darker to 5 % brighter and up to 8 % warmer or colder.
/// @param posed  0: as at the first visit
[[nodiscard]] VisitPose visitPose(std::uint64_t posed);

/// The ulcers of a foot at a visit: with their rims drawn in, their beds filled, in two parts.
[[nodiscard]] std::vector<UlcerDesign> ulcersAt(const SimulatorOptions& options);

}  // namespace tarsus
