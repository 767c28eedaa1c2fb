#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace tarsus {

/// The outline seen upright on its best-fit plane [mm]: what a photograph would give.
struct FlatOutline {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();  ///< axes of the plane, scan frame
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
};

/// @param outward  side of the plane that the viewer stands on
[[nodiscard]] FlatOutline flatten(std::span<const Eigen::Vector3d> closed_mm,
                                  const Eigen::Vector3d& outward);

[[nodiscard]] double areaOf(const FlatOutline& outline);

struct LengthWidth {
  double length_mm = 0.0;
  double width_mm = 0.0;
};
/// Greatest chord, and greatest chord at right angles to it; chords run from edge to edge, also
/// over what a concave outline leaves out.
[[nodiscard]] LengthWidth greatestChords(const FlatOutline& outline);
/// Longest chord parallel to an axis of the scan frame laid onto the plane, and longest chord at
/// right angles to it. Not the outline's extents, which are greater where it lies slanted.
/// @param axis  not upright on the plane
[[nodiscard]] LengthWidth chordsAlong(const FlatOutline& outline, const Eigen::Vector3d& axis);

}  // namespace tarsus
