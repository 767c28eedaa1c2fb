#include "reconstruction/pipeline/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace tarsus {
namespace {

/// Points of an ellipsoid with these half axes, turned about z, where `seen` says so.
PreviewSurface ellipsoid(const Eigen::Vector3f& half_mm,
                         const std::function<bool(const Eigen::Vector3f&)>& seen,
                         float weight) {
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.4F, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  PreviewSurface surface;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    // Fibonacci lattice: even over the sphere.
    const float z = 1.0F - (2.0F * static_cast<float>(i) + 1.0F) / kPoints;
    const float angle =
        std::numbers::pi_v<float> * (1.0F + std::sqrt(5.0F)) * static_cast<float>(i);
    const float r = std::sqrt(1.0F - z * z);
    const Eigen::Vector3f unit(r * std::cos(angle), r * std::sin(angle), z);
    if (seen(unit)) {
      surface.mesh.vertices.push_back(turn * unit.cwiseProduct(half_mm) +
                                      Eigen::Vector3f(50.0F, -20.0F, 400.0F));
      surface.mesh.normals.push_back(turn * unit.cwiseQuotient(half_mm).normalized());
      surface.weight.push_back(weight);
    }
  }
  return surface;
}

const Eigen::Vector3f kFootlike(120.0F, 45.0F, 35.0F);

TEST(Coverage, NothingSeenHasNoCells) {
  const Coverage coverage = coverageOf({}, {});
  EXPECT_TRUE(coverage.cells.empty());
  EXPECT_EQ(coverage.percent, 0.0);
  EXPECT_EQ(coverage.percentOfFace(0), 0.0);
}

TEST(Coverage, SeenAllRoundIsComplete) {
  const Coverage coverage = coverageOf(ellipsoid(
                                           kFootlike, [](const auto&) { return true; }, 20.0F),
                                       {});
  EXPECT_EQ(coverage.cells.size(), 54U);
  EXPECT_EQ(coverage.percent, 100.0);
  EXPECT_EQ(coverage.well_seen_percent, 100.0);
  // One in 200 left out at each end: the tips of the ellipsoid, 1 % of its height.
  EXPECT_NEAR(coverage.half_size_mm[0], 120.0F, 2.5F);
  EXPECT_NEAR(coverage.half_size_mm[2], 35.0F, 1.0F);
  EXPECT_NEAR((coverage.center_mm - Eigen::Vector3f(50.0F, -20.0F, 400.0F)).norm(), 0.0F, 1.0F);
  EXPECT_GT(
      std::abs(coverage.axes.row(0).dot(Eigen::RowVector3f(std::cos(0.4F), std::sin(0.4F), 0.0F))),
      0.999F);
}

TEST(Coverage, ThinlySeenSurfaceDoesNotCount) {
  const Coverage coverage = coverageOf(ellipsoid(
                                           kFootlike, [](const auto&) { return true; }, 4.0F),
                                       {});
  EXPECT_EQ(coverage.percent, 0.0);
  EXPECT_EQ(coverage.well_seen_percent, 0.0);
  EXPECT_EQ(std::count(coverage.cells.begin(), coverage.cells.end(), CellState::SeenPoorly), 54);
}

TEST(Coverage, GrowsWithWhatIsSeen) {
  double before = 0.0;
  for (const float lowest : {0.5F, 0.0F, -0.5F, -2.0F}) {
    const Coverage coverage = coverageOf(
        ellipsoid(
            kFootlike, [&](const Eigen::Vector3f& unit) { return unit.z() > lowest; }, 20.0F),
        {});
    EXPECT_GT(coverage.percent, before) << lowest;
    before = coverage.percent;
  }
  EXPECT_EQ(before, 100.0);
}

TEST(Coverage, HalfSeenLeavesTheFarFaceOpen) {
  const PreviewSurface half = ellipsoid(
      kFootlike, [](const Eigen::Vector3f& unit) { return unit.z() > 0.0F; }, 20.0F);
  const Coverage coverage = coverageOf(half, {});
  const double up = coverage.percentOfFace(4);
  const double down = coverage.percentOfFace(5);
  EXPECT_EQ(std::max(up, down), 100.0);
  EXPECT_EQ(std::min(up, down), 0.0);
  EXPECT_LT(coverage.percent, 85.0);  // 9 of 54 cells are missing for certain
  CoverageOptions without_far;
  without_far.open_directions = {-Eigen::Vector3f::UnitZ()};
  const Coverage asked = coverageOf(half, without_far);
  EXPECT_GT(asked.percent, coverage.percent);
  EXPECT_EQ(std::count(asked.cells.begin(), asked.cells.end(), CellState::NotAsked), 9);
}

TEST(Coverage, TheSupportIsNotAskedFor) {
  CoverageOptions options;
  // The lower tip of the ellipsoid stands on it.
  options.support = Eigen::Hyperplane<float, 3>(Eigen::Vector3f::UnitZ(), -365.0F);
  const Coverage coverage = coverageOf(ellipsoid(
                                           kFootlike, [](const auto&) { return true; }, 20.0F),
                                       options);
  EXPECT_EQ(std::count(coverage.cells.begin(), coverage.cells.end(), CellState::NotAsked), 9);
  EXPECT_EQ(coverage.percentOfFace(5), 0.0);
  EXPECT_EQ(coverage.percent, 100.0);
  EXPECT_NEAR(coverage.center_mm.z(), 400.0F, 1.0F);
  EXPECT_NEAR(coverage.axes(2, 2), 1.0F, 1e-5F);
}

}  // namespace
}  // namespace tarsus
