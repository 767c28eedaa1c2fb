#pragma once

#include <Eigen/Core>

namespace tarsus {

/// The biconic of optical design (ISO 10110-12) with the curvature matrix C [1/mm],
///   h(x) = x'Cx / (1 + sqrt(1 - x'C^2x)),
/// with what its fit and its normals need. Plane, sphere and cylinder are exact special cases.
struct SkinBase {
  double height = 0.0;  ///< [mm]
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  Eigen::Vector3d by_curvature = Eigen::Vector3d::Zero();  ///< by C11, C12, C22
};
[[nodiscard]] SkinBase skinBase(const Eigen::Matrix2d& curvature, const Eigen::Vector2d& x);

}  // namespace tarsus
