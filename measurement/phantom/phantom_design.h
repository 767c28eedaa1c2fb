#pragma once

#include "measurement/phantom/crater.h"
#include "reconstruction/scene/frame.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace tarsus {

/// Around an opening the skin is of the exact form this far, along the skin: what the reference
/// skin is fitted to (2 mm to the skin curve, then 8 mm), and some more.
inline constexpr double kExactSkin_mm = 11.5;
/// The skin curve's distance from the opening.
inline constexpr double kSkinCurveOffset_mm = 2.0;

struct PhantomWound {
  std::string name;  ///< one word
  std::string site;  ///< for people
  Crater crater;
  RigidTransform phantom_from_wound = RigidTransform::Identity();
};

/// To be checked with a caliper before a print is trusted.
struct ControlDistance {
  std::string what;
  double mm = 0.0;
};

/// A body that stands on a flat base, so that it prints without support and its top is a height
/// over the plan. Phantom frame: z up from the base at z = 0 [mm].
struct PhantomDesign {
  std::string name;
  std::string title;
  std::vector<Eigen::Vector2d> plan;  ///< convex, counter-clockwise, points about 1.2 mm apart
  std::function<double(const Eigen::Vector2d&)> healthy_top_mm;  ///< height without wounds
  std::vector<PhantomWound> wounds;
  std::array<ControlDistance, 2> control_distances;
};

/// The foot block first, then the plates.
[[nodiscard]] std::vector<PhantomDesign> phantomDesigns();

}  // namespace tarsus
