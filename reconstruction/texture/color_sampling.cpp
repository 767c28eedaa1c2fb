#include "reconstruction/texture/color_sampling.h"

#include <algorithm>
#include <array>

namespace tarsus {
namespace {

/// Weights of the four samples around a place `t` after the second.
std::array<float, 4> catmullRom(float t) {
  const float t2 = t * t;
  const float t3 = t2 * t;
  return {0.5F * (-t + 2.0F * t2 - t3),
          0.5F * (2.0F - 5.0F * t2 + 3.0F * t3),
          0.5F * (t + 4.0F * t2 - 3.0F * t3),
          0.5F * (t3 - t2)};
}

}  // namespace

Eigen::Vector3f sampleColor(const ColorImage& image, float u, float v) {
  const int left = std::clamp(static_cast<int>(u), 0, image.width() - 2);
  const int top = std::clamp(static_cast<int>(v), 0, image.height() - 2);
  const float a = u - static_cast<float>(left);
  const float b = v - static_cast<float>(top);
  const Eigen::Vector3f upper =
      (1.0F - a) * colorVector(image.at(left, top)) + a * colorVector(image.at(left + 1, top));
  const Eigen::Vector3f lower = (1.0F - a) * colorVector(image.at(left, top + 1)) +
                                a * colorVector(image.at(left + 1, top + 1));
  return (1.0F - b) * upper + b * lower;
}

Eigen::Vector3f sampleColorBicubic(const ColorImage& image, float u, float v) {
  const int left = std::clamp(static_cast<int>(u), 0, image.width() - 2);
  const int top = std::clamp(static_cast<int>(v), 0, image.height() - 2);
  const std::array<float, 4> across = catmullRom(u - static_cast<float>(left));
  const std::array<float, 4> down = catmullRom(v - static_cast<float>(top));
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int j = 0; j < 4; ++j) {
    const int row = std::clamp(top + j - 1, 0, image.height() - 1);
    Eigen::Vector3f line = Eigen::Vector3f::Zero();
    for (int i = 0; i < 4; ++i) {
      const int column = std::clamp(left + i - 1, 0, image.width() - 1);
      line += across[static_cast<std::size_t>(i)] * colorVector(image.at(column, row));
    }
    sum += down[static_cast<std::size_t>(j)] * line;
  }
  return sum;
}

Image<float> intensityImage(const ColorImage& image, const ColorGain& gain) {
  Image<float> intensity(image.width(), image.height());
  std::ranges::transform(image.pixels(), intensity.pixels().begin(), [&](Rgb8 c) {
    return intensityOf(gain.leveled(colorVector(c)));
  });
  return intensity;
}

}  // namespace tarsus
