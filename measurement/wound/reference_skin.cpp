#include "measurement/wound/reference_skin.h"

#include "measurement/wound/skin_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

/// The biconic turns vertical where x'C^2x = 1; beyond this it is held.
constexpr double kSteepest = 0.9;

}  // namespace

std::string_view referenceSkinMethod() { return "biconic annulus fit 1"; }

std::vector<Eigen::Vector2i> freeTerms(int degree, bool biconic) {
  std::vector<Eigen::Vector2i> terms;
  for (int order = 0; order <= degree; ++order) {
    if (order == 2 && biconic) {
      continue;  // carried by C
    }
    for (int i = order; i >= 0; --i) {
      terms.emplace_back(i, order - i);
    }
  }
  return terms;
}

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

ReferenceSkin::Shape ReferenceSkin::heightAt(const Eigen::Vector2d& uv) const {
  Shape shape;
  if (biconic_) {
    const SkinBase base = skinBase(curvature_, uv);
    shape = {base.height, base.gradient, base.hessian};
  }
  // Powers from u^-2 on, so that derivatives need no special case: their factors are 0 there.
  constexpr int kShift = 2;
  std::array<double, 10> pu{0.0, 0.0, 1.0};
  std::array<double, 10> pv{0.0, 0.0, 1.0};
  for (int i = 1; i <= degree_; ++i) {
    pu[i + kShift] = pu[i + kShift - 1] * uv.x() / unit_mm_;
    pv[i + kShift] = pv[i + kShift - 1] * uv.y() / unit_mm_;
  }
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double c = coefficients_[static_cast<Eigen::Index>(k)];
    const int i = terms_[k].x();
    const int j = terms_[k].y();
    const double* u = &pu[i + kShift];
    const double* v = &pv[j + kShift];
    const double c1 = c / unit_mm_;
    const double c2 = c1 / unit_mm_;
    shape.base += c * u[0] * v[0];
    shape.gradient.x() += c1 * i * u[-1] * v[0];
    shape.gradient.y() += c1 * j * u[0] * v[-1];
    shape.hessian(0, 0) += c2 * i * (i - 1) * u[-2] * v[0];
    shape.hessian(1, 1) += c2 * j * (j - 1) * u[0] * v[-2];
    shape.hessian(0, 1) += c2 * i * j * u[-1] * v[-1];
  }
  shape.hessian(1, 0) = shape.hessian(0, 1);  // the biconic's is symmetric, too
  return shape;
}

Eigen::Vector3d ReferenceSkin::at(const Eigen::Vector2d& uv) const {
  return scan_from_skin_ * Eigen::Vector3d(uv.x(), uv.y(), heightAt(uv).base);
}

ReferenceSkin::Foot ReferenceSkin::footOf(const Eigen::Vector3d& p_mm) const {
  constexpr double kConverged_mm = 1e-9;
  constexpr double kLongestStep_mm = 3.0;
  const Eigen::Vector3d p = scan_from_skin_.inverse() * p_mm;
  Eigen::Vector2d uv = p.head<2>();
  Shape shape = heightAt(uv);
  for (int i = 0; i < 40; ++i) {
    // The line from p to the skin must stand upright on both tangents.
    const double rise = p.z() - shape.base;
    const Eigen::Vector2d miss = p.head<2>() - uv + rise * shape.gradient;
    const Eigen::Matrix2d flat =
        Eigen::Matrix2d::Identity() + shape.gradient * shape.gradient.transpose();
    Eigen::Matrix2d slope = flat - rise * shape.hessian;
    if (slope.determinant() < 0.05 || slope.trace() < 0.0) {
      slope = flat;  // near the centre of curvature: Gauss-Newton still goes the right way
    }
    Eigen::Vector2d step = slope.inverse() * miss;
    step *= std::min(1.0, kLongestStep_mm / std::max(step.norm(), 1e-300));
    uv += step;
    shape = heightAt(uv);
    if (step.norm() < kConverged_mm) {
      break;
    }
  }
  Foot foot;
  foot.uv = uv;
  const Eigen::Vector3d on_skin(uv.x(), uv.y(), shape.base);
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-shape.gradient.x(), -shape.gradient.y(), 1.0).normalized();
  foot.position_mm = scan_from_skin_ * on_skin;
  foot.normal = scan_from_skin_.linear() * normal;
  foot.depth_mm = (on_skin - p).dot(normal);
  return foot;
}

Eigen::VectorXd ReferenceSkin::sensitivityAt(const Eigen::Vector2d& uv) const {
  return skinSensitivity({.curvature = curvature_,
                          .unit_mm = unit_mm_,
                          .degree = degree_,
                          .biconic = biconic_,
                          .terms = terms_},
                         uv);
}

double ReferenceSkin::sigmaAt(const Eigen::Vector2d& uv) const {
  const Eigen::VectorXd g = sensitivityAt(uv);
  return std::sqrt(std::max(0.0, g.dot(covariance_ * g)));
}

Eigen::Vector2d ReferenceSkin::curvatures() const {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(heightAt(Eigen::Vector2d::Zero()).hessian)
      .eigenvalues();
}

}  // namespace tarsus
