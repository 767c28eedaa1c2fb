#include "reconstruction/texture/color_sampling.h"

#include <algorithm>

namespace tarsus {
namespace {

Eigen::Vector3f toVector(Rgb8 c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

}  // namespace

Eigen::Vector3f sampleColor(const ColorImage& image, float u, float v) {
  const int left = std::clamp(static_cast<int>(u), 0, image.width() - 2);
  const int top = std::clamp(static_cast<int>(v), 0, image.height() - 2);
  const float a = u - static_cast<float>(left);
  const float b = v - static_cast<float>(top);
  const Eigen::Vector3f upper =
      (1.0F - a) * toVector(image.at(left, top)) + a * toVector(image.at(left + 1, top));
  const Eigen::Vector3f lower =
      (1.0F - a) * toVector(image.at(left, top + 1)) + a * toVector(image.at(left + 1, top + 1));
  return (1.0F - b) * upper + b * lower;
}

IntensityGradient intensityGradient(const ColorImage& image) {
  const int width = image.width();
  const int height = image.height();
  IntensityGradient result{
      Image<float>(width, height), Image<float>(width, height), Image<float>(width, height)};
  std::transform(
      image.pixels().begin(), image.pixels().end(), result.intensity.pixels().begin(), [](Rgb8 c) {
        return intensityOf(toVector(c));
      });
  const Image<float>& f = result.intensity;
  for (int v = 1; v + 1 < height; ++v) {
    for (int u = 1; u + 1 < width; ++u) {
      const float right = f.at(u + 1, v - 1) + 2.0F * f.at(u + 1, v) + f.at(u + 1, v + 1);
      const float left = f.at(u - 1, v - 1) + 2.0F * f.at(u - 1, v) + f.at(u - 1, v + 1);
      const float lower = f.at(u - 1, v + 1) + 2.0F * f.at(u, v + 1) + f.at(u + 1, v + 1);
      const float upper = f.at(u - 1, v - 1) + 2.0F * f.at(u, v - 1) + f.at(u + 1, v - 1);
      result.du.at(u, v) = (right - left) / 8.0F;
      result.dv.at(u, v) = (lower - upper) / 8.0F;
    }
  }
  return result;
}

}  // namespace tarsus
