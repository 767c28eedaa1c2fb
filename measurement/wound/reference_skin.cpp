#include "measurement/wound/reference_skin.h"

#include "measurement/wound/skin_base.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace tarsus {

std::string_view referenceSkinMethod() { return "biconic kriging 2"; }

ReferenceSkin::Shape ReferenceSkin::shapeAt(const Eigen::Vector2d& uv) const {
  const SkinBase base = skinBase(curvature_, uv);
  const DepartureTable::Shape departure = table_.at(uv);
  return {.height = base.height + departure.height + plane_[0] + plane_.tail<2>().dot(uv),
          .gradient = base.gradient + departure.gradient + plane_.tail<2>(),
          .hessian = base.hessian + departure.hessian};
}

Eigen::Vector3d ReferenceSkin::at(const Eigen::Vector2d& uv) const {
  return scan_from_skin_ * Eigen::Vector3d(uv.x(), uv.y(), shapeAt(uv).height);
}

ReferenceSkin::Foot ReferenceSkin::footOf(const Eigen::Vector3d& p_mm) const {
  constexpr double kConverged_mm = 1e-9;
  constexpr double kLongestStep_mm = 3.0;
  const Eigen::Vector3d p = scan_from_skin_.inverse() * p_mm;
  Eigen::Vector2d uv = p.head<2>();
  Shape shape = shapeAt(uv);
  for (int i = 0; i < 40; ++i) {
    // The line from p to the skin must stand upright on both tangents.
    const double rise = p.z() - shape.height;
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
    shape = shapeAt(uv);
    if (step.norm() < kConverged_mm) {
      break;
    }
  }
  Foot foot;
  foot.uv = uv;
  const Eigen::Vector3d on_skin(uv.x(), uv.y(), shape.height);
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-shape.gradient.x(), -shape.gradient.y(), 1.0).normalized();
  foot.position_mm = scan_from_skin_ * on_skin;
  foot.normal = scan_from_skin_.linear() * normal;
  foot.depth_mm = (on_skin - p).dot(normal);
  return foot;
}

Eigen::MatrixXd ReferenceSkin::covariance(const Eigen::Matrix2Xd& uv) const {
  const Eigen::Index count = uv.cols();
  Eigen::Matrix<double, Eigen::Dynamic, 6> base(count, 6);
  Eigen::VectorXd cosine(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    base.row(i) << skinBase(curvature_, uv.col(i)).by_curvature.transpose(), 1.0,
        uv.col(i).transpose();
    cosine[i] = 1.0 / std::sqrt(1.0 + shapeAt(uv.col(i)).gradient.squaredNorm());
  }
  return cosine.asDiagonal() * departure_->covariance(uv, base) * cosine.asDiagonal();
}

Eigen::Vector2d ReferenceSkin::curvatures() const {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(shapeAt(Eigen::Vector2d::Zero()).hessian)
      .eigenvalues();
}

}  // namespace tarsus
