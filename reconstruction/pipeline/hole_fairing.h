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

/// The surface of least change of curvature through a filling: minimises the integral of
/// |grad Laplace x|^2 over the inner points plus 1 / smoothing_mm^6 times that of
/// trust |x - given|^2. So a spherical bed stays spherical (a thin plate, |Laplace x|^2, flattens
/// it: 0.3 mm in a crater 8 mm deep), and slope and curvature at the rim come from a band of
/// surface, not from its last, noisy row of triangles. Source: Botsch and Kobbelt, An intuitive
/// framework for real-time freeform modeling, 2004 (the orders of fairing); the soft tie is our
/// own.
/// @param smoothing_mm  noise of the given points is smoothed over this length
/// @return  where all points of the patch belong; the given ones where they were smoothed to. Empty
///          where the equations have no solution.
[[nodiscard]] std::vector<Eigen::Vector3d> fairedPoints(const FairingPatch& patch,
                                                        double smoothing_mm);

}  // namespace tarsus
