#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace tarsus {

using ClosedCurve = std::vector<Eigen::Vector3d>;  ///< the last point joins the first [mm]

[[nodiscard]] double lengthOf(std::span<const Eigen::Vector3d> curve);

/// About `spacing_mm` apart along the curve, evenly.
[[nodiscard]] ClosedCurve resampled(std::span<const Eigen::Vector3d> curve, double spacing_mm);

/// Joins pieces of curve, each given by the names of its two ends, to closed loops of names.
[[nodiscard]] std::vector<std::vector<int>> joinLoops(std::span<const Eigen::Vector2i> pieces);

[[nodiscard]] double distanceTo(std::span<const Eigen::Vector3d> curve, const Eigen::Vector3d& p);

/// Lengths and area of a closed curve by the definitions of clinical.md section 2.
struct CurveFigures {
  double projected_area_mm2 = 0.0;
  double length_mm = 0.0;  ///< greatest chord
  double width_mm = 0.0;   ///< greatest chord at right angles to it, in the best-fit plane
  double length_clock_mm = 0.0;
  double width_clock_mm = 0.0;
};
/// @param heel_toe  direction; projected on the curve's best-fit plane
[[nodiscard]] CurveFigures figuresOf(std::span<const Eigen::Vector3d> curve,
                                     const Eigen::Vector3d& heel_toe);

}  // namespace tarsus
