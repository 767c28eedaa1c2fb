#include "measurement/wound/skin_departure.h"

#include "measurement/wound/matern.h"
#include "reconstruction/base/parallel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

/// Prior precisions of the parameters: wide, they only keep the solution defined. Curvature up to
/// 10 / mm, height 1 km, tilt 1000.
const SkinDeparture::Parameters kPrior =
    (SkinDeparture::Parameters() << 1e-2, 1e-2, 1e-2, 1e-12, 1e-6, 1e-6).finished();
/// Amplitudes with less of the evidence than this are dropped.
constexpr double kLeastWeight = 1e-4;

constexpr double kNode_mm = 1.5;  ///< of the table; a tenth of the correlation length

}  // namespace

SkinDeparture::Candidate SkinDeparture::solve(const Eigen::MatrixXd& alike,
                                              const DepartureKind& kind) const {
  Candidate c;
  c.kind = kind;
  c.root = kind.amplitude_mm * kind.amplitude_mm * alike;
  c.root.diagonal() += cells_.precision.cwiseInverse();
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(c.root);
  const auto root = c.root.triangularView<Eigen::Lower>();
  Eigen::Matrix<double, Eigen::Dynamic, 7> known(cells_.count(), 7);
  known << cells_.base, cells_.value_mm;
  root.solveInPlace(known);
  c.base = known.leftCols<6>();
  Eigen::Matrix<double, 6, 6> information = c.base.transpose() * c.base;
  information.diagonal() += kPrior;
  c.information.compute(information);
  c.parameters = c.information.solve(c.base.transpose() * known.col(6));
  c.rest = known.col(6) - c.base * c.parameters;
  c.log_evidence = -0.5 * c.rest.squaredNorm() - c.root.diagonal().array().log().sum() -
                   0.5 * c.information.vectorD().array().log().sum();
  return c;
}

/// #cells x #cells correlation of the departures along the normals.
Eigen::MatrixXd SkinDeparture::alikeness(double length_mm) const {
  return cells_.cosine.asDiagonal() * across(cells_.uv, length_mm) * cells_.cosine.asDiagonal();
}

Eigen::MatrixXd SkinDeparture::across(const Eigen::Matrix2Xd& uv, double length_mm) const {
  const Eigen::ArrayX2d cells = cells_.uv.transpose();
  Eigen::MatrixXd result(cells_.count(), uv.cols());
  for (Eigen::Index j = 0; j < uv.cols(); ++j) {
    matern(uv.col(j), cells, length_mm, result.col(j));
  }
  return result;
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
    const Eigen::VectorXd pull = c.root.triangularView<Eigen::Lower>().adjoint().solve(c.rest);
    auto& sum_of_pulls = pull_by_length_[c.kind.length_mm];
    if (sum_of_pulls.size() == 0) {
      sum_of_pulls.setZero(cells_.count());
    }
    sum_of_pulls +=
        c.weight * c.kind.amplitude_mm * c.kind.amplitude_mm * cells_.cosine.cwiseProduct(pull);
  }
}

double SkinDeparture::at(const Eigen::Vector2d& uv) const {
  const Eigen::ArrayX2d cells = cells_.uv.transpose();
  Eigen::VectorXd alike(cells_.count());
  double height = 0.0;
  for (const auto& [length_mm, pull] : pull_by_length_) {
    matern(uv, cells, length_mm, alike);
    height += pull.dot(alike);
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
  const Eigen::ArrayX2d all = uv.transpose();
  Eigen::MatrixXd among(places, places);
  for (const Candidate& c : candidates_) {
    for (Eigen::Index j = 0; j < places; ++j) {
      matern(uv.col(j), all, c.kind.length_mm, among.col(j));
    }
    const double variance = c.kind.amplitude_mm * c.kind.amplitude_mm;
    const Eigen::MatrixXd known = c.root.triangularView<Eigen::Lower>().solve(
        variance * cells_.cosine.asDiagonal() * across(uv, c.kind.length_mm));
    const Eigen::MatrixXd tilt = base - known.transpose() * c.base;
    heights.emplace_back(base * c.parameters + known.transpose() * c.rest);
    mean += c.weight * heights.back();
    result += c.weight * (variance * among - known.transpose() * known +
                          tilt * c.information.solve(tilt.transpose()));
  }
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Eigen::VectorXd off = heights[k] - mean;
    result += candidates_[k].weight * off * off.transpose();
  }
  return result;
}

DepartureTable::DepartureTable(std::shared_ptr<const SkinDeparture> departure,
                               const Eigen::Vector2d& low_mm,
                               const Eigen::Vector2d& high_mm)
    : departure_(std::move(departure)), low_mm_(low_mm) {
  const Eigen::Vector2d size = (high_mm - low_mm) / kNode_mm;
  const auto nodes = [](double cells) { return static_cast<Eigen::Index>(std::ceil(cells)) + 3; };
  heights_.setConstant(nodes(size.x()), nodes(size.y()), std::numeric_limits<double>::quiet_NaN());
}

void DepartureTable::fill() { fillWhere(Needed::Constant(heights_.rows(), heights_.cols(), true)); }

void DepartureTable::fillUnder(const Eigen::Matrix2Xd& uv) {
  if (heights_.size() == 0) {
    return;
  }
  Needed needed = Needed::Constant(heights_.rows(), heights_.cols(), false);
  for (Eigen::Index k = 0; k < uv.cols(); ++k) {
    const Eigen::Vector2i cell = locate(uv.col(k)).cell;
    needed.block<4, 4>(cell.x(), cell.y()) = true;
  }
  fillWhere(needed);
}

void DepartureTable::fillWhere(const Needed& needed) {
  parallelFor(static_cast<int>(heights_.cols()), [&](int j) {
    for (Eigen::Index i = 0; i < heights_.rows(); ++i) {
      if (needed(i, j) && std::isnan(heights_(i, j))) {
        heights_(i, j) = departure_->at(
            low_mm_ + kNode_mm * Eigen::Vector2d(static_cast<double>(i) - 1.0, j - 1.0));
      }
    }
  });
}

DepartureTable::Place DepartureTable::locate(const Eigen::Vector2d& uv) const {
  Place place;
  for (int k = 0; k < 2; ++k) {
    const auto cells = static_cast<double>((k == 0 ? heights_.rows() : heights_.cols()) - 3);
    const double x = std::min(std::max(0.0, (uv[k] - low_mm_[k]) / kNode_mm), cells);
    const double cell = std::min(std::floor(x), cells - 1.0);
    place.cell[k] = static_cast<int>(cell);
    place.inside[k] = x - cell;
  }
  return place;
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
  const Place place = locate(uv);
  const CubicWeights u = cubicWeights(place.inside.x());
  const CubicWeights v = cubicWeights(place.inside.y());
  const Eigen::Matrix4d h = heights_.block<4, 4>(place.cell.x(), place.cell.y());
  Shape shape;
  shape.height = u.value.dot(h * v.value);
  shape.gradient = Eigen::Vector2d(u.first.dot(h * v.value), u.value.dot(h * v.first)) / kNode_mm;
  const double mixed = u.first.dot(h * v.first);
  shape.hessian << u.second.dot(h * v.value), mixed, mixed, u.value.dot(h * v.second);
  shape.hessian /= kNode_mm * kNode_mm;
  return shape;
}

}  // namespace tarsus
