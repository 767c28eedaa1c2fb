#include "measurement/wound/skin_departure.h"

#include "measurement/wound/matern.h"
#include "measurement/wound/reference_skin.h"
#include "reconstruction/base/parallel.h"
#include "tests/measurement/outline/wound_surface.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace tarsus {
namespace {

using Base = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// By definition, with the library's own exponential.
double maternOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double length_mm) {
  const double x = std::sqrt(5.0) * (a - b).norm() / length_mm;
  return (1.0 + x + x * x / 3.0) * std::exp(-x);
}

/// The base of a plane: quadratic, constant, slopes.
Base flatBase(const Eigen::Matrix2Xd& uv) {
  Base base(uv.cols(), 6);
  for (Eigen::Index i = 0; i < uv.cols(); ++i) {
    const double u = uv(0, i);
    const double v = uv(1, i);
    base.row(i) << 0.5 * u * u, u * v, 0.5 * v * v, 1.0, u, v;
  }
  return base;
}

/// Cells around a hole, `noise_mm` each.
SkinCells cellsAround(double from_mm, double to_mm, double noise_mm) {
  std::vector<Eigen::Vector2d> places;
  constexpr double kCell_mm = 3.0;
  for (double v = -to_mm; v <= to_mm; v += kCell_mm) {
    for (double u = -to_mm; u <= to_mm; u += kCell_mm) {
      const double r = std::hypot(u, v);
      if (r >= from_mm && r <= to_mm) {
        places.emplace_back(u, v);
      }
    }
  }
  SkinCells cells;
  const auto count = static_cast<Eigen::Index>(places.size());
  cells.uv.resize(2, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    cells.uv.col(i) = places[static_cast<std::size_t>(i)];
  }
  cells.value_mm = Eigen::VectorXd::Zero(count);
  cells.cosine = Eigen::VectorXd::Ones(count);
  cells.precision = Eigen::VectorXd::Constant(count, 1.0 / (noise_mm * noise_mm));
  cells.base = flatBase(cells.uv);
  return cells;
}

const std::vector<DepartureKind> kAmplitudes{
    {0.01, 15.0}, {0.1, 15.0}, {0.3, 15.0}, {1.0, 15.0}, {3.0, 15.0}};

TEST(Matern, IsItsFormulaFromNearToFar) {
  Eigen::ArrayX2d places(400, 2);
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    // 0 to 25 km: beyond what a double can hold the tail is 0.
    const double r = i == 0 ? 0.0 : 1e-3 * std::pow(1.0435, static_cast<double>(i));
    places.row(i) << 1.0 + 0.6 * r, -2.0 + 0.8 * r;
  }
  const Eigen::Vector2d p(1.0, -2.0);
  Eigen::VectorXd result(places.rows());
  matern(p, places, 10.0, result);
  EXPECT_EQ(result[0], 1.0);
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    const double expected = maternOf(p, places.row(i).transpose().matrix(), 10.0);
    EXPECT_NEAR(result[i], expected, 1e-15 + 1e-13 * expected) << i;
  }
}

/// Universal kriging the other way round: the weights of the values that are best without bias, by
/// one linear system with Lagrange multipliers (Cressie, Statistics for Spatial Data, 3.4).
TEST(SkinDeparture, PosteriorOfATinyCaseIsThatOfTheKrigingSystem) {
  SkinCells cells;
  cells.uv.resize(2, 8);
  cells.uv << -9.0, -4.0, 1.0, 6.0, 11.0, -7.0, 3.0, 8.0, 2.0, -8.0, 9.0, -6.0, 4.0, 10.0, -12.0,
      12.0;
  cells.value_mm.resize(8);
  cells.value_mm << 0.1, -0.2, 0.4, 0.3, -0.1, 0.25, 0.05, -0.3;
  cells.cosine.resize(8);
  cells.cosine << 1.0, 0.9, 0.95, 0.8, 0.85, 0.99, 0.92, 0.7;
  cells.precision.resize(8);
  cells.precision << 100.0, 50.0, 80.0, 25.0, 100.0, 60.0, 90.0, 40.0;
  cells.base = cells.cosine.asDiagonal() * flatBase(cells.uv);
  const DepartureKind kind{.amplitude_mm = 0.7, .length_mm = 12.0};
  const SkinDeparture departure(cells, std::span(&kind, 1));

  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(14, 14);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      system(i, j) = 0.49 * cells.cosine[i] * cells.cosine[j] *
                         maternOf(cells.uv.col(i), cells.uv.col(j), 12.0) +
                     (i == j ? 1.0 / cells.precision[i] : 0.0);
    }
  }
  system.topRightCorner<8, 6>() = cells.base;
  system.bottomLeftCorner<6, 8>() = cells.base.transpose();
  Eigen::Matrix2Xd places(2, 3);
  places << 0.0, 5.0, -6.0, 0.0, 1.0, 7.0;
  const Base base = flatBase(places);
  Eigen::MatrixXd asked(14, 3);
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 8; ++i) {
      asked(i, k) = 0.49 * cells.cosine[i] * maternOf(cells.uv.col(i), places.col(k), 12.0);
    }
  }
  asked.bottomRows<6>() = base.transpose();
  const Eigen::MatrixXd weights = system.fullPivLu().solve(asked);

  const Eigen::MatrixXd covariance = departure.covariance(places, base);
  for (int k = 0; k < 3; ++k) {
    const double height = base.row(k).dot(departure.parameters()) + departure.at(places.col(k));
    // The wide prior of the parameters is all that differs.
    EXPECT_NEAR(height, weights.col(k).head<8>().dot(cells.value_mm), 1e-5);
    for (int l = 0; l < 3; ++l) {
      const double expected =
          0.49 * maternOf(places.col(k), places.col(l), 12.0) - weights.col(k).dot(asked.col(l));
      EXPECT_NEAR(covariance(k, l), expected, 1e-4 * covariance(k, k)) << k << l;
    }
  }
  EXPECT_NEAR(departure.amplitude_mm(), 0.7, 1e-12);
}

TEST(SkinDeparture, EvidencePrefersNoDepartureWhereThereIsNone) {
  SkinCells cells = cellsAround(12.0, 30.0, 0.1);
  cells.value_mm =
      cells.base * (SkinDeparture::Parameters() << -0.03, 0.0, -0.03, 0.2, 0.1, 0.0).finished();
  const SkinDeparture departure(cells, kAmplitudes);
  EXPECT_LT(departure.amplitude_mm(), 0.1);
  EXPECT_NEAR(departure.at(Eigen::Vector2d::Zero()), 0.0, 1e-4);
  EXPECT_NEAR(departure.parameters()[0], -0.03, 1e-6);
}

TEST(SkinDeparture, EvidenceFindsTheSizeOfADeparture) {
  for (const double size_mm : {0.3, 1.0}) {
    double squares = 0.0;
    constexpr int kSeeds = 10;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const test::CorrelatedNoise bumps(size_mm, 8.0, static_cast<std::uint64_t>(seed));
      SkinCells cells = cellsAround(12.0, 30.0, 0.05);
      for (Eigen::Index i = 0; i < cells.count(); ++i) {
        cells.value_mm[i] = bumps.at({cells.uv(0, i), cells.uv(1, i), 0.0});
      }
      const double found = SkinDeparture(cells, kAmplitudes).amplitude_mm();
      squares += found * found / kSeeds;
    }
    // The candidates lie a factor of 3 apart, and Gaussian bumps are not quite Matern's.
    EXPECT_GT(std::sqrt(squares), size_mm / 2.0);
    EXPECT_LT(std::sqrt(squares), size_mm * 3.0);
  }
}

TEST(SkinDeparture, CovarianceIsPositiveAndGrowsAwayFromTheCells) {
  const test::CorrelatedNoise bumps(0.3, 8.0, 3);
  SkinCells cells = cellsAround(12.0, 30.0, 0.1);
  for (Eigen::Index i = 0; i < cells.count(); ++i) {
    cells.value_mm[i] = bumps.at({cells.uv(0, i), cells.uv(1, i), 0.0});
  }
  const SkinDeparture departure(cells, kAmplitudes);
  Eigen::Matrix2Xd places(2, 60);
  for (int i = 0; i < 60; ++i) {
    const double r = 0.4 * i;
    places.col(i) << r * std::cos(2.4 * i), r * std::sin(2.4 * i);
  }
  const Eigen::MatrixXd covariance = departure.covariance(places, flatBase(places));
  EXPECT_LT((covariance - covariance.transpose()).cwiseAbs().maxCoeff(), 1e-9);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-9);
  // On a cell no worse than the cell itself; in the middle of the hole worst of all inside it.
  Eigen::Matrix2Xd on_cell = cells.uv.col(cells.count() / 2);
  EXPECT_LT(departure.covariance(on_cell, flatBase(on_cell))(0, 0), 0.01);
  EXPECT_GT(covariance(0, 0), 2.0 * covariance(35, 35));  // middle; 14 mm away, among the cells
  EXPECT_GT(covariance(0, 0), 0.01);
}

std::shared_ptr<const SkinDeparture> someDeparture() {
  const test::CorrelatedNoise bumps(0.5, 8.0, 7);
  SkinCells cells = cellsAround(10.0, 24.0, 0.1);
  for (Eigen::Index i = 0; i < cells.count(); ++i) {
    cells.value_mm[i] = bumps.at({cells.uv(0, i), cells.uv(1, i), 0.0});
  }
  return std::make_shared<const SkinDeparture>(cells, kAmplitudes);
}

TEST(DepartureTable, IsTheDepartureToAMicrometreOrTwo) {
  const auto departure = someDeparture();
  DepartureTable table(departure, {-24.0, -24.0}, {24.0, 24.0});
  table.fill();
  double greatest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double r = 23.0 * std::sqrt((i + 0.5) / 200);
    const Eigen::Vector2d p(r * std::cos(2.4 * i), r * std::sin(2.4 * i));
    greatest = std::max(greatest, std::abs(departure->at(p)));
    // A node each tenth of the length that it alters within: third order leaves (1/10)^3 and less.
    EXPECT_NEAR(table.at(p).height, departure->at(p), 0.002);
  }
  EXPECT_GT(greatest, 0.3);  // or there was nothing to tabulate
  EXPECT_NEAR(table.at({-24.0 + 6.0, -24.0 + 9.0}).height, departure->at({-18.0, -15.0}), 1e-12);
}

TEST(DepartureTable, DerivativesAreThoseOfItsHeights) {
  DepartureTable table(someDeparture(), {-24.0, -24.0}, {24.0, 24.0});
  table.fill();
  constexpr double kStep_mm = 1e-4;
  const Eigen::Vector2d u(kStep_mm, 0.0);
  const Eigen::Vector2d v(0.0, kStep_mm);
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(3.3, -7.1), Eigen::Vector2d(-12.7, 15.2)}) {
    const auto at = [&](const Eigen::Vector2d& q) { return table.at(q); };
    const Eigen::Vector2d gradient =
        Eigen::Vector2d(at(p + u).height - at(p - u).height, at(p + v).height - at(p - v).height) /
        (2.0 * kStep_mm);
    EXPECT_LT((at(p).gradient - gradient).norm(), 1e-7);
    Eigen::Matrix2d hessian;
    hessian.col(0) = (at(p + u).gradient - at(p - u).gradient) / (2.0 * kStep_mm);
    hessian.col(1) = (at(p + v).gradient - at(p - v).gradient) / (2.0 * kStep_mm);
    EXPECT_LT((at(p).hessian - hessian).norm(), 1e-7);
  }
}

TEST(DepartureTable, IsConstantOutsideAndNothingWhereEmpty) {
  DepartureTable table(someDeparture(), {-24.0, -24.0}, {24.0, 24.0});
  table.fill();
  EXPECT_EQ(table.at({100.0, 5.0}).height, table.at({1000.0, 5.0}).height);
  const DepartureTable empty;
  EXPECT_EQ(empty.at({1.0, 2.0}).height, 0.0);
  EXPECT_EQ(empty.at({1.0, 2.0}).gradient.norm(), 0.0);
}

TEST(DepartureTable, PartlyFilledGivesTheSameBitsThereAndNoneElsewhere) {
  const auto departure = someDeparture();
  DepartureTable all(departure, {-24.0, -24.0}, {24.0, 24.0});
  all.fill();
  DepartureTable some(departure, {-24.0, -24.0}, {24.0, 24.0});
  Eigen::Matrix2Xd places(2, 3);
  places << 3.3, -23.9, 50.0, -7.1, 15.2, 50.0;  // the last beyond the box
  some.fillUnder(places);
  for (const auto& p : places.colwise()) {
    EXPECT_EQ(some.at(p).height, all.at(p).height);
    EXPECT_EQ(some.at(p).hessian, all.at(p).hessian);
  }
  EXPECT_TRUE(std::isnan(some.at({-10.0, -10.0}).height));
}

TEST(SkinDeparture, GivesTheSameBitsForAnyNumberOfThreads) {
  const Eigen::Vector2d p(1.5, -2.5);
  const auto heights = [&] {
    const auto departure = someDeparture();
    DepartureTable table(departure, {-24.0, -24.0}, {24.0, 24.0});
    table.fill();
    return std::pair(departure->at(p), table.at(p).height);
  };
  const auto many = heights();
  const ThreadLimit one(1);
  EXPECT_EQ(heights(), many);
}

}  // namespace
}  // namespace tarsus
