// A crater's exact values against closed forms derived apart, and against fine sums over its bed.
#include "measurement/phantom/crater.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of sums of some hundred terms.
constexpr double kRelative = 1e-12;

void expectSame(double value, double truth) { EXPECT_NEAR(value, truth, kRelative * truth); }

TEST(Crater, FlatIsAFrustum) {
  const double a = 10.0;
  const double b = 4.0;
  const double d = 6.0;
  const CraterValues v = exactValues({{}, a, b, d});
  expectSame(v.opening_area_mm2, kPi * a * a);
  expectSame(v.perimeter_mm, 2.0 * kPi * a);
  expectSame(v.volume_mm3, kPi * d * (a * a + a * b + b * b) / 3.0);
  expectSame(v.bed_area_mm2, kPi * b * b + kPi * (a + b) * std::hypot(d, a - b));
  expectSame(v.mean_depth_mm, v.volume_mm3 / v.opening_area_mm2);
  EXPECT_EQ(v.max_depth_mm, d);
}

/// 2 pi times the integral of (R^3 - rho^3) / 3 sin t; rho falls linearly from the rim inward, and
/// rho^3 sin t has the primitive below (integration by parts, three times).
double sphereVolume(double radius, double a, double b, double d) {
  const double floor_angle = b / radius;
  const double rim_angle = a / radius;
  const double q = d / (rim_angle - floor_angle);  // rho rises outward
  const auto primitive = [&](double t) {
    const double rho = radius - d + q * (t - floor_angle);
    return -rho * rho * rho * std::cos(t) + 3.0 * q * rho * rho * std::sin(t) +
           6.0 * q * q * rho * std::cos(t) - 6.0 * q * q * q * std::sin(t);
  };
  const double r3 = radius * radius * radius;
  const double floor3 = std::pow(radius - d, 3);
  const double floor = (r3 - floor3) * (1.0 - std::cos(floor_angle));
  const double wall = r3 * (std::cos(floor_angle) - std::cos(rim_angle)) -
                      (primitive(rim_angle) - primitive(floor_angle));
  return 2.0 * kPi / 3.0 * (floor + wall);
}

TEST(Crater, SphereMatchesItsClosedForm) {
  for (const double radius : {30.0, 44.0}) {
    const CraterValues v = exactValues({{SkinForm::Sphere, radius}, 11.0, 6.0, 5.0});
    expectSame(v.opening_area_mm2, 2.0 * kPi * radius * radius * (1.0 - std::cos(11.0 / radius)));
    expectSame(v.perimeter_mm, 2.0 * kPi * radius * std::sin(11.0 / radius));
    // The closed form takes differences of cubes of the radius: 1e-15 of them remain.
    EXPECT_NEAR(v.volume_mm3, sphereVolume(radius, 11.0, 6.0, 5.0), 1e-10 * v.volume_mm3);
  }
}

TEST(Crater, CylinderMatchesItsClosedForm) {
  const double radius = 44.0;
  const double a = 9.0;
  const double b = 6.0;
  const double d = 3.0;
  const double w = a - b;
  const CraterValues v = exactValues({{SkinForm::Cylinder, radius}, a, b, d});
  expectSame(v.opening_area_mm2, kPi * a * a);
  expectSame(v.perimeter_mm, 2.0 * kPi * a);
  const double sum = kPi * d * (a * a + a * b + b * b) / 3.0;  // of the depth over the skin
  const double wall_squares = a * w * w * w / 3.0 - w * w * w * w / 4.0;
  const double squares = kPi * b * b * d * d + 2.0 * kPi * d * d / (w * w) * wall_squares;
  expectSame(v.volume_mm3, sum - squares / (2.0 * radius));
}

TEST(Crater, SharpCurvatureTendsToFlat) {
  const CraterValues flat = exactValues({{}, 10.0, 5.0, 4.0});
  for (const SkinForm form : {SkinForm::Cylinder, SkinForm::Sphere}) {
    const CraterValues nearly = exactValues({{form, 1e7}, 10.0, 5.0, 4.0});
    EXPECT_NEAR(nearly.bed_area_mm2, flat.bed_area_mm2, 1e-3);
    EXPECT_NEAR(nearly.volume_mm3, flat.volume_mm3, 1e-3);
  }
}

/// Area of the bed and volume between bed and skin from flat pieces; converges with the square of
/// their size.
struct Summed {
  double bed_mm2 = 0.0;
  double volume_mm3 = 0.0;
};
Summed summed(const Crater& crater, int steps) {
  Summed sum;
  const auto band = [&](double from, double to) {
    for (int i = 0; i < steps; ++i) {
      for (int k = 0; k < 6 * steps; ++k) {
        const double r0 = from + (to - from) * i / steps;
        const double r1 = from + (to - from) * (i + 1) / steps;
        const double t0 = 2.0 * kPi * k / (6 * steps);
        const double t1 = 2.0 * kPi * (k + 1) / (6 * steps);
        const auto piece = [&](const Crater& surface, double& area, double& moment) {
          const Eigen::Vector3d p = bedPoint(surface, r0, t0);
          const Eigen::Vector3d q = bedPoint(surface, r1, t0);
          const Eigen::Vector3d s = bedPoint(surface, r1, t1);
          const Eigen::Vector3d u = bedPoint(surface, r0, t1);
          area += 0.5 * (q - p).cross(s - p).norm() + 0.5 * (s - p).cross(u - p).norm();
          moment += (p.dot(q.cross(s)) + p.dot(s.cross(u))) / 6.0;
        };
        Crater skin = crater;
        skin.depth_mm = 0.0;
        double skin_area = 0.0;
        double below = 0.0;
        double above = 0.0;
        piece(crater, sum.bed_mm2, below);
        piece(skin, skin_area, above);
        sum.volume_mm3 += above - below;  // both meet at the rim: nothing else bounds them
      }
    }
  };
  band(0.0, crater.floor_radius_mm);
  band(crater.floor_radius_mm, crater.radius_mm);
  return sum;
}

TEST(Crater, FineSumsOverEveryFormConverge) {
  for (const Crater& crater : {Crater{{}, 12.0, 6.0, 6.0},
                               Crater{{SkinForm::Cylinder, 44.0}, 12.0, 7.0, 5.0},
                               Crater{{SkinForm::Sphere, 30.0}, 10.0, 6.0, 4.0}}) {
    const CraterValues v = exactValues(crater);
    const Summed coarse = summed(crater, 10);
    const Summed fine = summed(crater, 40);
    EXPECT_NEAR(fine.bed_mm2, v.bed_area_mm2, 1e-3 * v.bed_area_mm2);
    EXPECT_NEAR(fine.volume_mm3, v.volume_mm3, 1e-3 * v.volume_mm3);
    // Four times finer: sixteen times nearer, as second order must be.
    EXPECT_NEAR((coarse.bed_mm2 - v.bed_area_mm2) / (fine.bed_mm2 - v.bed_area_mm2), 16.0, 1.0);
    EXPECT_NEAR((coarse.volume_mm3 - v.volume_mm3) / (fine.volume_mm3 - v.volume_mm3), 16.0, 1.0);
  }
}

TEST(Crater, BedLiesItsDepthBelowTheSkinAlongTheNormal) {
  const Crater crater{{SkinForm::Cylinder, 44.0}, 12.0, 7.0, 5.0};
  const Eigen::Vector3d axis_point(0.0, 0.0, -44.0);
  for (const double r : {0.0, 5.0, 7.0, 9.5, 12.0, 15.0}) {
    const Eigen::Vector3d p = bedPoint(crater, r, 0.7) - axis_point;
    const double from_axis = std::hypot(p.x(), p.z());
    EXPECT_NEAR(from_axis, 44.0 - depthAt(crater, r), 1e-12);
  }
  EXPECT_EQ(depthAt(crater, 3.0), 5.0);
  EXPECT_EQ(depthAt(crater, 12.5), 0.0);
  EXPECT_NEAR(wallAngle(crater), kPi / 4.0, 1e-12);
}

TEST(Crater, AFloorTooSmallForThe99thPercentileIsABug) {
  EXPECT_THROW((void)exactValues({{}, 10.0, 0.5, 4.0}), std::logic_error);
  EXPECT_THROW((void)exactValues({{}, 10.0, 10.0, 4.0}), std::logic_error);
}

}  // namespace
}  // namespace tarsus
