#include "reconstruction/texture/keyframes.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace tarsus {
namespace {

constexpr int kHalfWidth_px = 4;  // of the 9-tap low-pass, as Crete et al.
constexpr int kTaps = 9;

/// Luminance in 1/256 grey levels, Rec. 601 weights; whole numbers, so that sums are exact.
Image<std::int32_t> luminance(const ColorImage& image) {
  Image<std::int32_t> result(image.width(), image.height());
  std::transform(image.pixels().begin(), image.pixels().end(), result.pixels().begin(), [](Rgb8 c) {
    return 77 * c.r + 150 * c.g + 29 * c.b;
  });
  return result;
}

/// Sums of |F(i) - F(i-1)|, and of the part of it that the low-pass removes, along one direction.
struct Variation {
  std::int64_t original = 0;
  std::int64_t removed = 0;  ///< times kTaps

  /// Neighbouring values of the 9-tap mean differ by (F(i+4) - F(i-5)) / 9: the filter telescopes.
  void add(std::int32_t here, std::int32_t before, std::int32_t ahead, std::int32_t behind) {
    const std::int32_t variation = std::abs(here - before);
    original += variation;
    removed += std::max(0, kTaps * variation - std::abs(ahead - behind));
  }
  /// A picture without any variation holds nothing sharp.
  [[nodiscard]] double blur() const {
    if (original == 0) {
      return 1.0;
    }
    const double kept = static_cast<double>(kTaps * original - removed);
    return kept / static_cast<double>(kTaps * original);
  }
};

Variation verticalVariation(const Image<std::int32_t>& f) {
  Variation sum;
  for (int v = 1; v < f.height(); ++v) {
    const int ahead = std::min(v + kHalfWidth_px, f.height() - 1);
    const int behind = std::max(v - kHalfWidth_px - 1, 0);
    for (int u = 1; u < f.width(); ++u) {
      sum.add(f.at(u, v), f.at(u, v - 1), f.at(u, ahead), f.at(u, behind));
    }
  }
  return sum;
}

Variation horizontalVariation(const Image<std::int32_t>& f) {
  Variation sum;
  for (int v = 1; v < f.height(); ++v) {
    for (int u = 1; u < f.width(); ++u) {
      const int ahead = std::min(u + kHalfWidth_px, f.width() - 1);
      const int behind = std::max(u - kHalfWidth_px - 1, 0);
      sum.add(f.at(u, v), f.at(u - 1, v), f.at(ahead, v), f.at(behind, v));
    }
  }
  return sum;
}

}  // namespace

double blurMeasure(const ColorImage& image) {
  const Image<std::int32_t> f = luminance(image);
  return std::max(verticalVariation(f).blur(), horizontalVariation(f).blur());
}

}  // namespace tarsus
