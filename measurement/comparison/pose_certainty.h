#pragma once

#include "measurement/comparison/pose_fit.h"

#include <span>

namespace tarsus {

/// How firmly skin holds a pose.
struct PoseCertainty {
  MotionMatrix covariance = MotionMatrix::Zero();  ///< of the motion vector about the centre
  MotionVector weakest = MotionVector::Zero();     ///< direction of the least information, a unit
  bool determined = false;  ///< false: some motion is not held at all; the covariance means nothing
  double correlation_area_mm2 = 0.0;  ///< of the residuals
};

/// Covariance s^2 f H^-1 of a converged pose. H sums J_a J_b^T (symmetric part), each row with the
/// normal of one visit: noise in the normals is independent between visits and cancels, where
/// J J^T would count it as shape and believe that noise holds a sphere in place (instrumental
/// variables). s^2 is the residuals' variance; f = 2 (1 + A / a) since both directions see the same
/// two surfaces, and residuals move together over the area A, the integral of their correlation up
/// to its first zero, while each sample stands for the area a.
[[nodiscard]] PoseCertainty certaintyOf(std::span<const SkinMatch> matches,
                                        const Eigen::Vector3d& center_mm,
                                        double sample_area_mm2,
                                        double reach_mm);

/// How a point moves with the motion vector: 3 x 6.
[[nodiscard]] Eigen::Matrix<double, 3, 6> motionAt(const Eigen::Vector3d& p_mm,
                                                   const Eigen::Vector3d& center_mm);

}  // namespace tarsus
