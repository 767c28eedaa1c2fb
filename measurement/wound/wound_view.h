#pragma once

#include "measurement/wound/measure.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace tarsus {

/// How one looks straight at a wound; unit vectors of the scan frame.
struct WoundView {
  Eigen::Vector3d toward_viewer = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  bool oriented =
      false;  ///< true: toes up, by the landmarks; false: along the model's longest axis
};

/// From outside along the reference skin's mean normal.
[[nodiscard]] WoundView viewOf(const TriangleMesh& foot,
                               const MeasuredWound& wound,
                               const std::optional<Landmarks>& landmarks);

/// The outline as seen in its view: x to the right, y down [mm], about its middle.
[[nodiscard]] std::vector<Eigen::Vector2d> outlineInView(const MeasuredWound& wound,
                                                         const WoundView& view);

}  // namespace tarsus
