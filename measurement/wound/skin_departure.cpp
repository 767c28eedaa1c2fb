#include "measurement/wound/skin_departure.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>

namespace tarsus {
namespace {

/// Prior precisions of the parameters: wide, they only keep the solution defined. Curvature up to
/// 10 / mm, height 1 km, tilt 1000.
const SkinDeparture::Parameters kPrior =
    (SkinDeparture::Parameters() << 1e-2, 1e-2, 1e-2, 1e-12, 1e-6, 1e-6).finished();
/// Amplitudes with less of the evidence than this are dropped.
constexpr double kLeastWeight = 1e-4;
/// The Matern 5/2 correlation.
double matern(double distance_mm, double length_mm) {
  const double x = std::sqrt(5.0) * distance_mm / length_mm;
  return (1.0 + x + x * x / 3.0) * std::exp(-x);
}

constexpr double kNode_mm = 1.5;  ///< of the table; a tenth of the correlation length

}  // namespace

SkinDeparture::Candidate SkinDeparture::solve(const Eigen::MatrixXd& alike,
                                              const DepartureKind& kind) const {
  Candidate c;
  c.kind = kind;
  const double variance = kind.amplitude_mm * kind.amplitude_mm;
  Eigen::MatrixXd covariance = variance * alike;
  covariance.diagonal() += cells_.precision.cwiseInverse();
  c.covariance.compute(covariance);
  c.weighed_base = c.covariance.solve(cells_.base);
  Eigen::Matrix<double, 6, 6> information = cells_.base.transpose() * c.weighed_base;
  information.diagonal() += kPrior;
  c.information.compute(information);
  c.parameters = c.information.solve(c.weighed_base.transpose() * cells_.value_mm);
  const Eigen::VectorXd rest = cells_.value_mm - cells_.base * c.parameters;
  const Eigen::VectorXd pull = c.covariance.solve(rest);
  c.pull = variance * cells_.cosine.cwiseProduct(pull);
  c.log_evidence = -0.5 * rest.dot(pull) - c.covariance.matrixLLT().diagonal().array().log().sum() -
                   0.5 * c.information.vectorD().array().log().sum();
  return c;
}

/// #cells x #cells correlation of the departures along the normals.
Eigen::MatrixXd SkinDeparture::alikeness(double length_mm) const {
  const Eigen::Index count = cells_.count();
  Eigen::MatrixXd alike(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      alike(i, j) = cells_.cosine[i] * cells_.cosine[j] *
                    matern((cells_.uv.col(i) - cells_.uv.col(j)).norm(), length_mm);
      alike(j, i) = alike(i, j);
    }
  }
  return alike;
}

SkinDeparture::SkinDeparture(SkinCells cells, std::span<const DepartureKind> kinds)
    : cells_(std::move(cells)), candidates_(kinds.size()) {
  std::map<double, Eigen::MatrixXd> alike;
  for (const DepartureKind& kind : kinds) {
    if (auto& matrix = alike[kind.length_mm]; matrix.size() == 0) {
      matrix = alikeness(kind.length_mm);
    }
  }
  parallelFor(static_cast<int>(kinds.size()), [&](int k) {
    const DepartureKind& kind = kinds[static_cast<std::size_t>(k)];
    candidates_[k] = solve(alike.at(kind.length_mm), kind);
  });
  const auto best = std::ranges::max_element(candidates_, {}, &Candidate::log_evidence);
  const double highest = best->log_evidence;
  for (Candidate& c : candidates_) {
    c.weight = std::exp(c.log_evidence - highest);
  }
  std::erase_if(candidates_, [](const Candidate& c) { return !(c.weight >= kLeastWeight); });
  double sum = 0.0;
  for (const Candidate& c : candidates_) {
    sum += c.weight;
  }
  for (Candidate& c : candidates_) {
    c.weight /= sum;
    parameters_ += c.weight * c.parameters;
  }
}

double SkinDeparture::at(const Eigen::Vector2d& uv) const {
  double height = 0.0;
  for (const Candidate& c : candidates_) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < cells_.count(); ++i) {
      sum += c.pull[i] * matern((cells_.uv.col(i) - uv).norm(), c.kind.length_mm);
    }
    height += c.weight * sum;
  }
  return height;
}

double SkinDeparture::amplitude_mm() const {
  double squares = 0.0;
  for (const Candidate& c : candidates_) {
    squares += c.weight * c.kind.amplitude_mm * c.kind.amplitude_mm;
  }
  return std::sqrt(squares);
}

Eigen::MatrixXd SkinDeparture::covariance(
    const Eigen::Matrix2Xd& uv, const Eigen::Matrix<double, Eigen::Dynamic, 6>& base) const {
  const Eigen::Index places = uv.cols();
  std::vector<Eigen::VectorXd> heights;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(places);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(places, places);
  for (const Candidate& c : candidates_) {
    Eigen::MatrixXd among(places, places);
    Eigen::MatrixXd across(cells_.count(), places);
    for (Eigen::Index j = 0; j < places; ++j) {
      for (Eigen::Index i = 0; i < places; ++i) {
        among(i, j) = matern((uv.col(i) - uv.col(j)).norm(), c.kind.length_mm);
      }
      for (Eigen::Index i = 0; i < cells_.count(); ++i) {
        across(i, j) = matern((cells_.uv.col(i) - uv.col(j)).norm(), c.kind.length_mm);
      }
    }
    heights.emplace_back(base * c.parameters + across.transpose() * c.pull);
    mean += c.weight * heights.back();
    const double variance = c.kind.amplitude_mm * c.kind.amplitude_mm;
    across = cells_.cosine.asDiagonal() * across;
    const Eigen::MatrixXd tilt = base - variance * across.transpose() * c.weighed_base;
    const Eigen::MatrixXd known = c.covariance.matrixL().solve(across);
    result += c.weight * (variance * among - variance * variance * known.transpose() * known +
                          tilt * c.information.solve(tilt.transpose()));
  }
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Eigen::VectorXd off = heights[k] - mean;
    result += candidates_[k].weight * off * off.transpose();
  }
  return result;
}

DepartureTable::DepartureTable(const SkinDeparture& departure,
                               const Eigen::Vector2d& low_mm,
                               const Eigen::Vector2d& high_mm)
    : low_mm_(low_mm) {
  const Eigen::Vector2d size = (high_mm - low_mm) / kNode_mm;
  const auto nodes = [](double cells) { return static_cast<Eigen::Index>(std::ceil(cells)) + 3; };
  heights_.resize(nodes(size.x()), nodes(size.y()));
  parallelFor(static_cast<int>(heights_.cols()), [&](int j) {
    for (Eigen::Index i = 0; i < heights_.rows(); ++i) {
      heights_(i, j) =
          departure.at(low_mm_ + kNode_mm * Eigen::Vector2d(static_cast<double>(i) - 1.0, j - 1.0));
    }
  });
}

namespace {

/// Weights of four neighbours, with first and second derivatives.
struct CubicWeights {
  Eigen::Vector4d value;
  Eigen::Vector4d first;
  Eigen::Vector4d second;
};

CubicWeights cubicWeights(double t) {
  CubicWeights w;
  const double t2 = t * t;
  const double t3 = t2 * t;
  w.value << -0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t,
      0.5 * t3 - 0.5 * t2;
  w.first << -1.5 * t2 + 2.0 * t - 0.5, 4.5 * t2 - 5.0 * t, -4.5 * t2 + 4.0 * t + 0.5, 1.5 * t2 - t;
  w.second << -3.0 * t + 2.0, 9.0 * t - 5.0, -9.0 * t + 4.0, 3.0 * t - 1.0;
  return w;
}

}  // namespace

DepartureTable::Shape DepartureTable::at(const Eigen::Vector2d& uv) const {
  if (heights_.size() == 0) {
    return {};
  }
  const auto locate = [](double x, Eigen::Index nodes) {
    const double cells = static_cast<double>(nodes - 3);
    const double inside = std::clamp(x, 0.0, cells);
    const double cell = std::min(std::floor(inside), cells - 1.0);
    return std::pair(static_cast<Eigen::Index>(cell), inside - cell);
  };
  const Eigen::Vector2d x = (uv - low_mm_) / kNode_mm;
  const auto [i, s] = locate(x.x(), heights_.rows());
  const auto [j, t] = locate(x.y(), heights_.cols());
  const CubicWeights u = cubicWeights(s);
  const CubicWeights v = cubicWeights(t);
  const Eigen::Matrix4d h = heights_.block<4, 4>(i, j);
  Shape shape;
  shape.height = u.value.dot(h * v.value);
  shape.gradient = Eigen::Vector2d(u.first.dot(h * v.value), u.value.dot(h * v.first)) / kNode_mm;
  const double mixed = u.first.dot(h * v.first);
  shape.hessian << u.second.dot(h * v.value), mixed, mixed, u.value.dot(h * v.second);
  shape.hessian /= kNode_mm * kNode_mm;
  return shape;
}

}  // namespace tarsus
