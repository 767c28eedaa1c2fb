#include "measurement/wound/extents.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using std::numbers::pi;

/// Ellipse with half axes a and b, its long one along x, turned by `pose`.
std::vector<Eigen::Vector3d> ellipse(double a, double b, const Eigen::Isometry3d& pose) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 720; ++i) {
    const double t = 2.0 * pi * i / 720;
    points.emplace_back(pose * Eigen::Vector3d(a * std::cos(t), b * std::sin(t), 0.0));
  }
  return points;
}

Eigen::Isometry3d somePose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()));
  pose.pretranslate(Eigen::Vector3d(120.0, -40.0, 300.0));
  return pose;
}

TEST(Extents, EllipseHasItsAxesAsLengthAndWidth) {
  const Eigen::Isometry3d pose = somePose();
  const FlatOutline flat = flatten(ellipse(10.0, 6.0, pose), pose.linear().col(2));
  EXPECT_NEAR(areaOf(flat), pi * 60.0, 0.01);  // a 720-gon lacks 2e-5 of it
  const LengthWidth chords = greatestChords(flat);
  EXPECT_NEAR(chords.length_mm, 20.0, 1e-3);
  EXPECT_NEAR(chords.width_mm, 12.0, 1e-3);
}

/// Longest chord of the ellipse along a direction at `turn` from its long axis: through its middle.
double ellipseChord(double a, double b, double turn) {
  return 2.0 / std::hypot(std::cos(turn) / a, std::sin(turn) / b);
}

TEST(Extents, ClockTakesTheLongestChordsAlongAndAcrossTheAxis) {
  const Eigen::Isometry3d pose = somePose();
  const FlatOutline flat = flatten(ellipse(10.0, 6.0, pose), pose.linear().col(2));
  for (const double turn : {0.0, pi / 6.0, pi / 4.0, 1.2, pi / 2.0}) {
    const Eigen::Vector3d axis =
        pose.linear() * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.4);  // leaves the plane
    const LengthWidth clock = chordsAlong(flat, axis);
    // A 720-gon's chord is at most 4e-5 of it too short.
    EXPECT_NEAR(clock.length_mm, ellipseChord(10.0, 6.0, turn), 1e-3) << turn;
    EXPECT_NEAR(clock.width_mm, ellipseChord(10.0, 6.0, turn + pi / 2.0), 1e-3) << turn;
  }
}

/// Half ring with radii `inner` and `outer` above the x axis.
std::vector<Eigen::Vector3d> crescent(double inner, double outer) {
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 360;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = pi * i / kSteps;
    points.emplace_back(outer * std::cos(t), outer * std::sin(t), 0.0);
  }
  for (int i = kSteps; i >= 0; --i) {
    const double t = pi * i / kSteps;
    points.emplace_back(inner * std::cos(t), inner * std::sin(t), 0.0);
  }
  return points;
}

TEST(Extents, ChordsOfACrescentRunFromEdgeToEdge) {
  const FlatOutline flat = flatten(crescent(6.0, 10.0), Eigen::Vector3d::UnitZ());
  const LengthWidth chords = greatestChords(flat);
  EXPECT_NEAR(chords.length_mm, 20.0, 1e-9);  // from tip to tip, over the open side
  EXPECT_NEAR(chords.width_mm, 8.0, 1e-3);    // at x = 6, where the inner arc meets the base
  const LengthWidth upright = chordsAlong(flat, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(upright.length_mm, 8.0, 1e-3);  // its extent is 10
  EXPECT_NEAR(upright.width_mm, 20.0, 1e-9);
}

TEST(Extents, ClockOfASlantedStripIsShorterThanItsExtents) {
  // 20 x 2 mm at 45 degrees: extents of 15.6 mm both ways, chords of 2 sqrt 2 mm.
  const Eigen::Isometry3d pose(Eigen::AngleAxisd(pi / 4.0, Eigen::Vector3d::UnitZ()));
  std::vector<Eigen::Vector3d> strip;
  for (const auto& [x, y] : {std::pair{-10.0, -1.0}, {10.0, -1.0}, {10.0, 1.0}, {-10.0, 1.0}}) {
    strip.emplace_back(pose * Eigen::Vector3d(x, y, 0.0));
  }
  const LengthWidth clock =
      chordsAlong(flatten(strip, Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitX());
  EXPECT_NEAR(clock.length_mm, 2.0 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(clock.width_mm, 2.0 * std::sqrt(2.0), 1e-9);
}

TEST(Extents, WidthIsAChordNotAnExtent) {
  // A sheared strip: seen along its diagonal its extent is greater than any chord across.
  const std::vector<Eigen::Vector3d> strip{{0, 0, 0}, {10, 4, 0}, {10, 6, 0}, {0, 2, 0}};
  const LengthWidth chords = greatestChords(flatten(strip, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector2d along = Eigen::Vector2d(10.0, 6.0).normalized();
  EXPECT_NEAR(chords.length_mm, std::hypot(10.0, 6.0), 1e-9);
  // The chord at right angles through a strip of height 2 along (10, 4).
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d side = Eigen::Vector2d(10.0, 4.0).normalized();
  const double strip_width = 2.0 * side.x();
  EXPECT_NEAR(chords.width_mm,
              strip_width / std::abs(across.dot(Eigen::Vector2d(-side.y(), side.x()))),
              1e-9);
}

}  // namespace
}  // namespace tarsus
