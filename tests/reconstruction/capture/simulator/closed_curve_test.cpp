#include "reconstruction/capture/simulator/closed_curve.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// An ellipse of half axes 12 and 7 mm, its long axis turned 30 degrees from x, on a tilted plane.
ClosedCurve tiltedEllipse(const Eigen::Matrix3d& tilt) {
  ClosedCurve curve;
  for (int i = 0; i < 720; ++i) {
    const double t = i * std::numbers::pi / 360.0;
    const Eigen::AngleAxisd turn(std::numbers::pi / 6.0, Vector3d::UnitZ());
    curve.push_back(tilt * (turn * Vector3d(12.0 * std::cos(t), 7.0 * std::sin(t), 0.0)));
  }
  return curve;
}

TEST(ClosedCurve, EllipseHasItsLengthsInBothConventions) {
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(0.7, Vector3d(1, 2, 0.5).normalized()).toRotationMatrix();
  const CurveFigures figures = figuresOf(tiltedEllipse(tilt), tilt * Vector3d::UnitX());
  // 720 corners inscribe the ellipse to about 0.001 mm.
  EXPECT_NEAR(figures.projected_area_mm2, std::numbers::pi * 12.0 * 7.0, 0.02);
  EXPECT_NEAR(figures.length_mm, 24.0, 0.005);
  EXPECT_NEAR(figures.width_mm, 14.0, 0.01);
  // Chords of an ellipse along a direction at angle a to its long axis, through the middle:
  // 2 / sqrt(cos^2 a / 12^2 + sin^2 a / 7^2).
  const auto chord = [](double a) { return 2.0 / std::hypot(std::cos(a) / 12, std::sin(a) / 7); };
  EXPECT_NEAR(figures.length_clock_mm, chord(std::numbers::pi / 6.0), 0.02);
  EXPECT_NEAR(figures.width_clock_mm, chord(std::numbers::pi / 3.0), 0.02);
}

TEST(ClosedCurve, ResamplingKeepsLengthAndSpacesEvenly) {
  const ClosedCurve curve = tiltedEllipse(Eigen::Matrix3d::Identity());
  const ClosedCurve even = resampled(curve, 1.0);
  EXPECT_EQ(even.size(), static_cast<std::size_t>(std::lround(lengthOf(curve))));
  EXPECT_NEAR(lengthOf(even), lengthOf(curve), 0.05);  // sagitta of 1 mm chords
  for (std::size_t i = 0; i < even.size(); ++i) {
    EXPECT_NEAR((even[(i + 1) % even.size()] - even[i]).norm(), 1.0, 0.02);
  }
}

TEST(ClosedCurve, PiecesJoinToLoopsWhateverTheirOrder) {
  const std::vector<Eigen::Vector2i> pieces = {
      {3, 1}, {10, 11}, {2, 3}, {1, 2}, {12, 10}, {11, 12}};
  const auto loops = joinLoops(pieces);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_EQ(loops[0].size(), 3U);
  EXPECT_EQ(loops[1].size(), 3U);
}

}  // namespace
}  // namespace tarsus
