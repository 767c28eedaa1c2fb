#pragma once

#include "measurement/wound/reference_skin.h"

#include <functional>
#include <span>

namespace tarsus::test {

struct AnnulusFitOptions {
  int degree = 2;             ///< of the free terms
  bool biconic = false;       ///< carries the terms of order 2
  double departure_mm = 0.0;  ///< prior of the terms of order 3 and up; 0: free
  double taper_mm = 1e9;      ///< weights fall as exp(-outside / taper)
  double reach_mm = 8.0;      ///< samples this far outside the skin curve
};

struct AnnulusFit {
  std::function<double(const Eigen::Vector2d&)> height;
  Eigen::Isometry3d scan_from_plane;
};

/// Polynomial, biconic, or both, by robust Gauss-Newton along the normals (Tukey weights).
[[nodiscard]] AnnulusFit fitAnnulus(std::span<const SkinSample> samples,
                                    Eigen::Isometry3d scan_from_plane,
                                    const AnnulusFitOptions& options);

}  // namespace tarsus::test
