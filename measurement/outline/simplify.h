#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace tarsus {

/// Indices of the points of a closed polyline that matter: the others lie within tolerance_mm of
/// the line through them. Keeps at least 3 where there are 3 different ones.
/// Source: Douglas and Peucker, 1973.
[[nodiscard]] std::vector<int> essentialPoints(std::span<const Eigen::Vector3d> closed_mm,
                                               double tolerance_mm);

/// The same for an open polyline; both ends are kept.
[[nodiscard]] std::vector<int> essentialPointsOfOpen(std::span<const Eigen::Vector3d> open_mm,
                                                     double tolerance_mm);

}  // namespace tarsus
