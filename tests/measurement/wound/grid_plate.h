#pragma once

#include "measurement/wound/reference_skin.h"

#include <functional>
#include <span>

namespace tarsus::test {

/// Plane z = 0 through the origin, z along the normal.
[[nodiscard]] Eigen::Isometry3d tangentFrame(const Eigen::Vector3d& origin_mm,
                                             const Eigen::Vector3d& normal);

struct PlateOptions {
  int order = 2;           ///< 2: bi-Laplacian (C1), 3: tri-Laplacian (C2)
  double length_mm = 2.0;  ///< detail finer than this is smoothed
};

/// A soft plate as a height field on a 1 mm grid,
///   min integral |D^order h|^2 length^(2 order) + sum area (z - h)^2.
[[nodiscard]] std::function<double(const Eigen::Vector2d&)> gridPlate(
    std::span<const SkinSample> samples,
    const Eigen::Isometry3d& scan_from_plane,
    const PlateOptions& options);

}  // namespace tarsus::test
