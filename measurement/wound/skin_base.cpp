#include "measurement/wound/skin_base.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// The biconic turns vertical where x'C^2x = 1; beyond this it is held.
constexpr double kSteepest = 0.9;

}  // namespace

SkinBase skinBase(const Eigen::Matrix2d& curvature, const Eigen::Vector2d& x) {
  const Eigen::Matrix2d squared = curvature * curvature;
  const Eigen::Vector2d cx = curvature * x;
  const double q = x.dot(cx);
  const double s = std::min(x.dot(squared * x), kSteepest);
  const double w = std::sqrt(1.0 - s);
  const double d = 1.0 + w;
  const Eigen::Vector2d q1 = 2.0 * cx;
  const Eigen::Vector2d s1 =
      s < kSteepest ? Eigen::Vector2d(2.0 * squared * x) : Eigen::Vector2d::Zero().eval();
  const Eigen::Vector2d w1 = -s1 / (2.0 * w);
  const Eigen::Matrix2d w2 = -squared / w - (s1 * s1.transpose()) / (4.0 * w * w * w);
  SkinBase base;
  base.height = q / d;
  base.gradient = q1 / d - q * w1 / (d * d);
  base.hessian = 2.0 * curvature / d -
                 (q1 * w1.transpose() + w1 * q1.transpose() + q * w2) / (d * d) +
                 2.0 * q * (w1 * w1.transpose()) / (d * d * d);
  // By C11, C12, C22: dq = (u^2, 2uv, v^2); ds = 2 (Cx)' dC x.
  const Eigen::Vector3d dq(x.x() * x.x(), 2.0 * x.x() * x.y(), x.y() * x.y());
  const Eigen::Vector3d ds(
      2.0 * cx.x() * x.x(), 2.0 * (cx.x() * x.y() + cx.y() * x.x()), 2.0 * cx.y() * x.y());
  const double dh_ds = s < kSteepest ? q / (d * d) / (2.0 * w) : 0.0;
  base.by_curvature = dq / d + dh_ds * ds;
  return base;
}

}  // namespace tarsus
