#pragma once

#include <Eigen/Core>

#include <vector>

namespace tarsus {

/// A filling with the surface round it.
struct FairingPatch {
  std::vector<Eigen::Vector3d> points;  ///< [mm]
  std::vector<Eigen::Vector3i> faces;
  /// #points: 0 where the point is free (made up), else how well it is known, 1 usually.
  std::vector<double> trust;
  std::vector<std::uint8_t> inner;  ///< #points 1: all faces round it are in the patch
};

/// The thin plate through a filling: minimises the integral of |Laplace x|^2 over the inner points
/// plus 1 / smoothing_mm^4 times that of trust |x - given|^2, so that slope and curvature at
/// the rim come from a band of surface, not from its last, noisy row of triangles.
/// @param smoothing_mm  noise of the given points is smoothed over this length
/// @return  where all points of the patch belong; the given ones where they were smoothed to. Empty
///          where the equations have no solution.
[[nodiscard]] std::vector<Eigen::Vector3d> fairedPoints(const FairingPatch& patch,
                                                        double smoothing_mm);

}  // namespace tarsus
