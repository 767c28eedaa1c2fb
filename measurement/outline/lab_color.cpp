#include "measurement/outline/lab_color.h"

#include <array>
#include <cmath>

namespace tarsus {
namespace {

std::array<double, 256> linearLight() {
  std::array<double, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double c = static_cast<double>(i) / 255.0;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return linear;
}

double lightness(double t) {
  constexpr double kKnee = 216.0 / 24389.0;
  constexpr double kSlope = 24389.0 / (27.0 * 116.0);
  return t > kKnee ? std::cbrt(t) : kSlope * t + 16.0 / 116.0;
}

}  // namespace

Eigen::Vector3d linearOf(Rgb8 color) {
  static const std::array<double, 256> kLinear = linearLight();
  return {kLinear[color.r], kLinear[color.g], kLinear[color.b]};
}

Eigen::Vector3d labOfLinear(const Eigen::Vector3d& linear_rgb) {
  const Eigen::Vector3d& c = linear_rgb;
  const double x = lightness(Eigen::Vector3d(0.4124564, 0.3575761, 0.1804375).dot(c) / 0.95047);
  const double y = lightness(Eigen::Vector3d(0.2126729, 0.7151522, 0.0721750).dot(c));
  const double z = lightness(Eigen::Vector3d(0.0193339, 0.1191920, 0.9503041).dot(c) / 1.08883);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Eigen::Vector3d labOf(Rgb8 color) { return labOfLinear(linearOf(color)); }

}  // namespace tarsus
