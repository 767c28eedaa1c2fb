#pragma once

#include "measurement/report/close_view.h"

namespace tarsus::sample {

/// A sole-like patch, toes towards +y, with an irregular bowl of a wound at kWoundAt.
struct Case {
  TexturedMesh foot;
  MeasuredWound wound;
  Landmarks landmarks;
};

inline const Eigen::Vector2d kWoundAt{8.0, 52.0};
inline constexpr double kBowlDepth_mm = 3.4;

/// Radius of the wound's outline over the flattened sole [mm].
[[nodiscard]] double outlineRadius(double angle);

/// Made once; copy it to change it.
[[nodiscard]] const Case& makeCase();

/// The case as a report: pictures taken (once), title, quality, version and time filled in.
[[nodiscard]] ReportContent makeContent();

}  // namespace tarsus::sample
