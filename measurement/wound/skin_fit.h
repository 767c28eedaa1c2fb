#pragma once

#include <Eigen/Core>

#include <vector>

namespace tarsus {

/// The biconic at x, with what its fit and its normals need.
struct SkinBase {
  double height = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  Eigen::Vector3d by_curvature = Eigen::Vector3d::Zero();  ///< by C11, C12, C22
};
[[nodiscard]] SkinBase skinBase(const Eigen::Matrix2d& curvature, const Eigen::Vector2d& x);

/// Exponents (i, j) of the free polynomial terms, by order.
[[nodiscard]] std::vector<Eigen::Vector2i> freeTerms(int degree, bool biconic);

/// What the parameters mean: C11, C12, C22 (biconic only), then the free terms.
struct SkinModel {
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
  double unit_mm = 1.0;
  int degree = 4;
  bool biconic = true;
  std::vector<Eigen::Vector2i> terms;
};
/// As many numbers as the fit has parameters, at most 32, without a heap allocation each.
using SkinVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 32, 1>;

/// Derivatives of the height at uv by the parameters.
[[nodiscard]] SkinVector skinSensitivity(const SkinModel& model, const Eigen::Vector2d& uv);

}  // namespace tarsus
