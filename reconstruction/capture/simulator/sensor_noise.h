#pragma once

#include "reconstruction/capture/simulator/renderer.h"

#include <cstdint>

namespace tarsus {

/// A coded-light camera of the SR300's class, as issue and toolchain describe it. All numbers are
/// our own choice except the first formula, which the issue fixes.
struct SensorModel {
  double noise = 1.0;  ///< 0: ideal; scales everything below
  std::uint64_t seed = 1;
  double max_incidence_deg = 75.0;     ///< nothing comes back beyond
  double edge_step_mm = 2.0;           ///< a larger step among 3 x 3 pixels is a depth edge ...
  double edge_step_share = 0.0145;     ///< ... plus this share of z: more than 75 degrees give
  double edge_hole_share = 0.45;       ///< of the pixels at an edge that return nothing
  double edge_flying_share = 0.25;     ///< of them that return something between near and far
  double projector_baseline_mm = 25.;  ///< the projector sits to the right: shadows to the left
  double max_range_mm = 1500.0;
};

/// sigma_z = (0.15 + 0.6 z[m]) mm / cos^1.5(incidence).
[[nodiscard]] double depthSigmaMm(double z_mm, double incidence_cos);

/// The depth image the sensor gives for an ideal view. The same bits for any number of threads.
[[nodiscard]] DepthImage senseDepth(const IdealView& view,
                                    const Intrinsics& camera,
                                    const SensorModel& model,
                                    int frame);

/// How the picture moves while the shutter is open.
struct Smear {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  ///< during the exposure
};

/// How long the shutter of this frame is open, as a share of the frame time: short, except for
/// some frames.
[[nodiscard]] double shutterShare(const SensorModel& model, int frame);

/// The colour image the sensor gives: smeared, with drifting exposure and white balance, noise.
[[nodiscard]] ColorImage senseColor(const Image<Eigen::Vector3f>& ideal,
                                    const SensorModel& model,
                                    const Smear& smear,
                                    int frame);

}  // namespace tarsus
