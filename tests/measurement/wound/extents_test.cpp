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

TEST(Extents, ClockFollowsTheHeelToeAxisAndNotTheLongestWay) {
  const Eigen::Isometry3d pose = somePose();
  const FlatOutline flat = flatten(ellipse(10.0, 6.0, pose), pose.linear().col(2));
  const double turn = pi / 6.0;
  const Eigen::Vector3d axis =
      pose.linear() * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.4);  // leaves the plane
  const LengthWidth clock = extentsAlong(flat, axis);
  // Extent of an ellipse along a direction: 2 sqrt(a^2 cos^2 + b^2 sin^2).
  EXPECT_NEAR(clock.length_mm, 2.0 * std::hypot(10.0 * std::cos(turn), 6.0 * std::sin(turn)), 2e-3);
  EXPECT_NEAR(clock.width_mm, 2.0 * std::hypot(10.0 * std::sin(turn), 6.0 * std::cos(turn)), 2e-3);
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
