#include "ui/work/images.h"

#include <QColor>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

// Nunez, Anderton, Renslow, "Optimizing colormaps with consideration for color vision deficiency",
// PLoS ONE 2018: cividis, near end first.
constexpr std::array<std::array<int, 3>, 7> kCividis{{{253, 231, 55},
                                                      {212, 193, 84},
                                                      {168, 156, 109},
                                                      {124, 123, 120},
                                                      {87, 92, 109},
                                                      {46, 63, 108},
                                                      {0, 34, 78}}};
constexpr QRgb kNothing = qRgb(26, 28, 34);

}  // namespace

QImage imageOf(const ColorImage& image) {
  QImage result(image.width(), image.height(), QImage::Format_RGB32);
  for (int v = 0; v < image.height(); ++v) {
    auto* line = reinterpret_cast<QRgb*>(result.scanLine(v));
    for (int u = 0; u < image.width(); ++u) {
      const Rgb8& p = image.at(u, v);
      line[u] = qRgb(p.r, p.g, p.b);
    }
  }
  return result;
}

QColor depthColor(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kCividis.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kCividis.size() - 2);
  const double part = at - static_cast<double>(low);
  const auto mix = [&](std::size_t k) {
    return static_cast<int>(
        std::lround((1.0 - part) * kCividis.at(low).at(k) + part * kCividis.at(low + 1).at(k)));
  };
  return {mix(0), mix(1), mix(2)};
}

QImage depthPicture(const DepthImage& depth_mm, double near_mm, double far_mm) {
  static const auto table = [] {
    std::array<QRgb, 256> colors{};
    for (std::size_t i = 0; i < colors.size(); ++i) {
      colors.at(i) = depthColor(static_cast<double>(i) / 255.0).rgb();
    }
    return colors;
  }();
  QImage result(depth_mm.width(), depth_mm.height(), QImage::Format_RGB32);
  for (int v = 0; v < depth_mm.height(); ++v) {
    auto* line = reinterpret_cast<QRgb*>(result.scanLine(v));
    for (int u = 0; u < depth_mm.width(); ++u) {
      const float z = depth_mm.at(u, v);
      const double share = std::clamp((z - near_mm) / (far_mm - near_mm), 0.0, 1.0);
      line[u] = z > 0.0F ? table.at(static_cast<std::size_t>(255.0 * share)) : kNothing;
    }
  }
  return result;
}

}  // namespace tarsus
