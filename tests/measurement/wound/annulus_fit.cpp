#include "tests/measurement/wound/annulus_fit.h"

#include "measurement/wound/skin_base.h"
#include "tests/measurement/wound/grid_plate.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus::test {
namespace {

/// Height over a plane: biconic (parameters 0 to 2) and free terms in units of `unit_mm`.
struct Shape {
  std::vector<Eigen::Vector2i> terms;
  Eigen::VectorXd parameters;
  double unit_mm = 1.0;

  Shape(const AnnulusFitOptions& options, double unit) : unit_mm(unit) {
    for (int order = 0; order <= options.degree; ++order) {
      for (int i = order; i >= 0 && !(options.biconic && order == 2); --i) {
        terms.emplace_back(i, order - i);
      }
    }
    parameters.setZero(3 + static_cast<Eigen::Index>(terms.size()));
  }

  [[nodiscard]] Eigen::Matrix2d curvature() const {
    return (Eigen::Matrix2d() << parameters[0], parameters[1], parameters[1], parameters[2])
        .finished();
  }
  /// Of the height by the parameters.
  [[nodiscard]] Eigen::VectorXd derivatives(const Eigen::Vector2d& uv) const {
    Eigen::VectorXd d(parameters.size());
    d.head<3>() = skinBase(curvature(), uv).by_curvature;
    // Powers by multiplication: this runs for every sample in every step.
    std::array<Eigen::Array2d, 5> power{Eigen::Array2d::Ones()};
    for (std::size_t n = 1; n < power.size(); ++n) {
      power[n] = power[n - 1] * uv.array() / unit_mm;
    }
    for (std::size_t k = 0; k < terms.size(); ++k) {
      d[3 + static_cast<Eigen::Index>(k)] = power[terms[k].x()].x() * power[terms[k].y()].y();
    }
    return d;
  }
  [[nodiscard]] double height(const Eigen::Vector2d& uv) const {
    const Eigen::Index free = parameters.size() - 3;
    return skinBase(curvature(), uv).height + parameters.tail(free).dot(derivatives(uv).tail(free));
  }
  [[nodiscard]] Eigen::Vector2d gradient(const Eigen::Vector2d& uv) const {
    constexpr double kStep_mm = 1e-4;
    const Eigen::Vector2d u(kStep_mm, 0.0);
    const Eigen::Vector2d v(0.0, kStep_mm);
    return Eigen::Vector2d(height(uv + u) - height(uv - u), height(uv + v) - height(uv - v)) /
           (2.0 * kStep_mm);
  }
};

struct Residual {
  double along_normal_mm;
  double cosine;
  Eigen::Vector2d foot;
};

std::vector<Residual> residualsOf(const Shape& shape, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Residual> all;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d gradient = shape.gradient(p.head<2>());
    const double rise = p.z() - shape.height(p.head<2>());
    const double steepness = 1.0 + gradient.squaredNorm();
    all.push_back({.along_normal_mm = rise / std::sqrt(steepness),
                   .cosine = 1.0 / std::sqrt(steepness),
                   .foot = p.head<2>() + std::clamp(rise, -1.0, 1.0) / steepness * gradient});
  }
  return all;
}

/// Where the Tukey weights vanish.
double cutOf(const std::vector<Residual>& residuals) {
  std::vector<double> absolute;
  for (const Residual& r : residuals) {
    absolute.push_back(std::abs(r.along_normal_mm));
  }
  const auto middle = absolute.begin() + static_cast<std::ptrdiff_t>(absolute.size() / 2);
  std::nth_element(absolute.begin(), middle, absolute.end());
  return 4.685 * std::max(0.05, 1.4826 * *middle);
}

/// Precision of each parameter before any sample.
Eigen::VectorXd priorOf(const Shape& shape, const AnnulusFitOptions& options) {
  constexpr double kHeld = 1e12;
  Eigen::VectorXd prior = Eigen::VectorXd::Zero(shape.parameters.size());
  prior.head<3>().setConstant(options.biconic ? 1e-2 : kHeld);
  for (std::size_t k = 0; k < shape.terms.size(); ++k) {
    if (shape.terms[k].sum() >= 3 && options.departure_mm > 0.0) {
      prior[3 + static_cast<Eigen::Index>(k)] = std::pow(options.departure_mm, -2);
    }
  }
  return prior;
}

void step(Shape& shape,
          const std::vector<Eigen::Vector3d>& points,
          const std::vector<double>& weights,
          const Eigen::VectorXd& prior,
          bool robust) {
  const auto residuals = residualsOf(shape, points);
  const double cut_mm = cutOf(residuals);
  Eigen::MatrixXd normal = prior.asDiagonal();
  Eigen::VectorXd right = -prior.cwiseProduct(shape.parameters);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = residuals[i].along_normal_mm / cut_mm;
    const double tukey = !robust ? 1.0 : std::abs(x) < 1.0 ? std::pow(1.0 - x * x, 2) : 0.0;
    const Eigen::VectorXd d = residuals[i].cosine * shape.derivatives(residuals[i].foot);
    normal += tukey * weights[i] * d * d.transpose();
    right += tukey * weights[i] * residuals[i].along_normal_mm * d;
  }
  shape.parameters += normal.ldlt().solve(right);
}

}  // namespace

AnnulusFit fitAnnulus(std::span<const SkinSample> samples,
                      Eigen::Isometry3d scan_from_plane,
                      const AnnulusFitOptions& options) {
  constexpr double kCorrelation_mm2 = 14.0;
  std::vector<double> weights;
  for (const SkinSample& s : samples) {
    weights.push_back(std::exp(-s.outside_mm / options.taper_mm) * s.area_mm2 /
                      (s.sigma_mm * s.sigma_mm * kCorrelation_mm2));
  }
  // The frame must stand upright, or a sphere is no biconic in it.
  constexpr int kFrames = 4;
  for (int round = 0;; ++round) {
    std::vector<Eigen::Vector3d> points;
    double unit_mm = 1.0;
    for (const SkinSample& s : samples) {
      points.emplace_back(scan_from_plane.inverse() * s.position_mm);
      unit_mm = std::max(unit_mm, points.back().head<2>().norm());
    }
    Shape shape(options, unit_mm);
    const Eigen::VectorXd prior = priorOf(shape, options);
    for (int i = 0; i < 6; ++i) {
      step(shape, points, weights, prior, i >= 3);
    }
    const Eigen::Vector2d tilt = shape.gradient(Eigen::Vector2d::Zero());
    if (round + 1 == kFrames || !options.biconic || tilt.norm() < 1e-5) {
      return {.height = [shape](const Eigen::Vector2d& uv) { return shape.height(uv); },
              .scan_from_plane = scan_from_plane};
    }
    scan_from_plane = tangentFrame(
        scan_from_plane * Eigen::Vector3d(0.0, 0.0, shape.height(Eigen::Vector2d::Zero())),
        scan_from_plane.linear() * Eigen::Vector3d(-tilt.x(), -tilt.y(), 1.0).normalized());
  }
}

}  // namespace tarsus::test
