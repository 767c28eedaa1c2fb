#include "measurement/phantom/crater.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;
constexpr double kTurn = 2.0 * std::numbers::pi;
/// The bed's area element is smooth and periodic in the angle: equal steps converge exponentially.
constexpr int kAngles = 64;
constexpr int kGaussPoints = 24;

struct GaussRule {
  std::array<double, kGaussPoints> x{};  ///< in (-1, 1)
  std::array<double, kGaussPoints> w{};
};

/// Roots of the Legendre polynomial by Newton's method (Golub and Welsch's rule, the simple way).
GaussRule makeGaussRule() {
  GaussRule rule;
  for (int i = 0; i < kGaussPoints; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (kGaussPoints + 0.5));
    double derivative = 1.0;
    for (int round = 0; round < 20; ++round) {
      double previous = 1.0;
      double value = x;
      for (int n = 2; n <= kGaussPoints; ++n) {
        const double next = ((2.0 * n - 1.0) * x * value - (n - 1.0) * previous) / n;
        previous = value;
        value = next;
      }
      derivative = kGaussPoints * (x * value - previous) / (x * x - 1.0);
      x -= value / derivative;
    }
    rule.x[i] = x;
    rule.w[i] = 2.0 / ((1.0 - x * x) * derivative * derivative);
  }
  return rule;
}

template <typename Function>
double integrate(double from, double to, const Function& f) {
  static const GaussRule rule = makeGaussRule();
  double sum = 0.0;
  for (int i = 0; i < kGaussPoints; ++i) {
    sum += rule.w[i] * f(0.5 * (from + to) + 0.5 * (to - from) * rule.x[i]);
  }
  return 0.5 * (to - from) * sum;
}

/// How the skin's polar coordinates stretch around the middle: a circle's length / 2 pi.
double circleFactor(const PhantomSkin& skin, double r_mm) {
  return skin.form == SkinForm::Sphere ? skin.radius_mm * std::sin(r_mm / skin.radius_mm) : r_mm;
}

/// Volume below 1 mm^2 of skin down to depth d: its area shrinks by 1 - t k in each curved
/// direction.
double columnVolume(const PhantomSkin& skin, double d) {
  switch (skin.form) {
    case SkinForm::Plane:
      return d;
    case SkinForm::Cylinder:
      return d - 0.5 * d * d / skin.radius_mm;
    case SkinForm::Sphere:
      return d - d * d / skin.radius_mm + d * d * d / (3.0 * skin.radius_mm * skin.radius_mm);
  }
  return d;
}

/// Area of the bed for each mm^2 of skin above it; `slope` is the depth's derivative along r.
double bedFactor(const PhantomSkin& skin, double d, double slope, double angle_rad) {
  if (skin.form == SkinForm::Cylinder) {
    const double around = 1.0 - d / skin.radius_mm;
    const double slope_around = slope * std::cos(angle_rad);
    const double slope_along = slope * std::sin(angle_rad);
    return std::sqrt(around * around * (1.0 + slope_along * slope_along) +
                     slope_around * slope_around);
  }
  const double both = skin.form == SkinForm::Plane ? 1.0 : 1.0 - d / skin.radius_mm;
  return both * std::sqrt(both * both + slope * slope);
}

double bedArea(const Crater& crater, double from, double to, double slope) {
  return integrate(from, to, [&](double r) {
    double mean = 0.0;
    for (int k = 0; k < kAngles; ++k) {
      mean += bedFactor(crater.skin, depthAt(crater, r), slope, kTurn * k / kAngles) / kAngles;
    }
    return kTurn * circleFactor(crater.skin, r) * mean;
  });
}

}  // namespace

Vector3d skinNormal(const PhantomSkin& skin, double r_mm, double angle_rad) {
  switch (skin.form) {
    case SkinForm::Plane:
      break;
    case SkinForm::Cylinder: {
      const double around = r_mm * std::cos(angle_rad) / skin.radius_mm;
      return {std::sin(around), 0.0, std::cos(around)};
    }
    case SkinForm::Sphere: {
      const double away = r_mm / skin.radius_mm;
      return {std::sin(away) * std::cos(angle_rad),
              std::sin(away) * std::sin(angle_rad),
              std::cos(away)};
    }
  }
  return Vector3d::UnitZ();
}

Vector3d skinPoint(const PhantomSkin& skin, double r_mm, double angle_rad) {
  const Vector3d normal = skinNormal(skin, r_mm, angle_rad);
  const Vector3d flat(r_mm * std::cos(angle_rad), r_mm * std::sin(angle_rad), 0.0);
  switch (skin.form) {
    case SkinForm::Plane:
      break;
    case SkinForm::Cylinder:
      return skin.radius_mm * (normal - Vector3d::UnitZ()) + Vector3d(0.0, flat.y(), 0.0);
    case SkinForm::Sphere:
      return skin.radius_mm * (normal - Vector3d::UnitZ());
  }
  return flat;
}

Vector3d bedPoint(const Crater& crater, double r_mm, double angle_rad) {
  return skinPoint(crater.skin, r_mm, angle_rad) -
         depthAt(crater, r_mm) * skinNormal(crater.skin, r_mm, angle_rad);
}

double depthAt(const Crater& crater, double r_mm) {
  const double share = (crater.radius_mm - r_mm) / (crater.radius_mm - crater.floor_radius_mm);
  return crater.depth_mm * std::clamp(share, 0.0, 1.0);
}

double wallAngle(const Crater& crater) {
  return std::atan2(crater.depth_mm, crater.radius_mm - crater.floor_radius_mm);
}

CraterValues exactValues(const Crater& crater) {
  TARSUS_REQUIRE(crater.floor_radius_mm > 0.1 * crater.radius_mm &&
                     crater.floor_radius_mm < crater.radius_mm && crater.depth_mm > 0.0,
                 "a crater with a floor of more than 1 % of its opening");
  const double a = crater.radius_mm;
  const double b = crater.floor_radius_mm;
  const double slope = -crater.depth_mm / (a - b);
  const auto volume = [&](double r) {
    return kTurn * circleFactor(crater.skin, r) * columnVolume(crater.skin, depthAt(crater, r));
  };
  const double radius = crater.skin.radius_mm;
  CraterValues values;
  values.perimeter_mm = kTurn * circleFactor(crater.skin, a);
  values.opening_area_mm2 = crater.skin.form == SkinForm::Sphere
                                ? kTurn * radius * radius * (1.0 - std::cos(a / radius))
                                : 0.5 * kTurn * a * a;
  values.volume_mm3 = integrate(0.0, b, volume) + integrate(b, a, volume);
  values.bed_area_mm2 = bedArea(crater, 0.0, b, 0.0) + bedArea(crater, b, a, slope);
  values.mean_depth_mm = values.volume_mm3 / values.opening_area_mm2;
  values.max_depth_mm = crater.depth_mm;
  return values;
}

}  // namespace tarsus
