#include "measurement/report/depth_colors.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

/// ColorBrewer's YlGnBu with a paler first step (Harrower and Brewer 2003).
constexpr std::array<Rgb8, 9> kAnchors{Rgb8{0xFF, 0xFF, 0xE0},
                                       Rgb8{0xED, 0xF8, 0xB1},
                                       Rgb8{0xC7, 0xE9, 0xB4},
                                       Rgb8{0x7F, 0xCD, 0xBB},
                                       Rgb8{0x41, 0xB6, 0xC4},
                                       Rgb8{0x1D, 0x91, 0xC0},
                                       Rgb8{0x22, 0x5E, 0xA8},
                                       Rgb8{0x25, 0x34, 0x94},
                                       Rgb8{0x08, 0x1D, 0x58}};

std::uint8_t mix(std::uint8_t a, std::uint8_t b, double t) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * t));
}

}  // namespace

Rgb8 depthColor(double depth_mm, double end_mm) {
  const double along =
      end_mm > 0.0 ? std::clamp(depth_mm / end_mm, 0.0, 1.0) * (kAnchors.size() - 1) : 0.0;
  const auto low = std::min(static_cast<std::size_t>(along), kAnchors.size() - 2);
  const double t = along - static_cast<double>(low);
  const Rgb8& a = kAnchors[low];
  const Rgb8& b = kAnchors[low + 1];
  return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

double depthScaleEnd(double deepest_mm) {
  const double step = deepest_mm <= 10.0 ? 1.0 : deepest_mm <= 20.0 ? 2.0 : 5.0;
  return std::max(1.0, std::ceil(deepest_mm / step - 1e-9) * step);
}

}  // namespace tarsus
