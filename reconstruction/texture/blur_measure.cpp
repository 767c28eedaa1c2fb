#include "reconstruction/texture/blur_measure.h"

#include "reconstruction/base/require.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <numeric>

namespace tarsus {
namespace {

constexpr int kHalfWidth_px = 4;  // of the 9-tap low-pass, as Crete et al.
constexpr int kTaps = 9;
constexpr int kLevel = 256;  // steps of a grey level

/// A row's sums must fit in 32 bits: kTaps * 255 * kLevel for each pixel.
constexpr int kWidest_px = 3600;

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

  /// A picture without any variation holds nothing sharp.
  [[nodiscard]] double blur() const {
    if (original == 0) {
      return 1.0;
    }
    const double kept = static_cast<double>(kTaps * original - removed);
    return kept / static_cast<double>(kTaps * original);
  }
};

/// Adds `count` pixels. Neighbouring values of the 9-tap mean differ by (F(i+4) - F(i-5)) / 9: the
/// filter telescopes. In pieces whose sums fit in 32 bits, where the compiler takes eight at once.
void add(const std::int32_t* here,
         const std::int32_t* before,
         const std::int32_t* ahead,
         const std::int32_t* behind,
         int count,
         Variation& sum) {
  for (int first = 0; first < count; first += kWidest_px) {
    std::int32_t original = 0;
    std::int32_t removed = 0;
    for (int i = first; i < std::min(count, first + kWidest_px); ++i) {
      const std::int32_t variation = std::abs(here[i] - before[i]);
      original += variation;
      removed += std::max(0, kTaps * variation - std::abs(ahead[i] - behind[i]));
    }
    sum.original += original;
    sum.removed += removed;
  }
}

const std::int32_t* row(const Image<std::int32_t>& f, int v) {
  return f.pixels().data() + static_cast<std::size_t>(std::clamp(v, 0, f.height() - 1)) *
                                 static_cast<std::size_t>(f.width());
}

Variation verticalVariation(const Image<std::int32_t>& f) {
  Variation sum;
  for (int v = 1; v < f.height(); ++v) {
    add(row(f, v) + 1,
        row(f, v - 1) + 1,
        row(f, v + kHalfWidth_px) + 1,
        row(f, v - kHalfWidth_px - 1) + 1,
        f.width() - 1,
        sum);
  }
  return sum;
}

Variation horizontalVariation(const Image<std::int32_t>& f) {
  Variation sum;
  const int inner = f.width() - 2 * kHalfWidth_px - 1;
  for (int v = 1; v < f.height(); ++v) {
    const std::int32_t* at = row(f, v);
    for (int u = 1; u < f.width(); ++u) {
      if (u == kHalfWidth_px + 1 && inner > 0) {
        add(at + u, at + u - 1, at + u + kHalfWidth_px, at, inner, sum);
        u += inner;
      }
      const int ahead = std::min(u + kHalfWidth_px, f.width() - 1);
      const int behind = std::max(u - kHalfWidth_px - 1, 0);
      add(at + u, at + u - 1, at + ahead, at + behind, 1, sum);
    }
  }
  return sum;
}

double blurOf(const Image<std::int32_t>& f) {
  return std::max(verticalVariation(f).blur(), horizontalVariation(f).blur());
}

}  // namespace

double blurMeasure(const ColorImage& image) { return blurOf(luminance(image)); }

PictureQuality assessPicture(const RgbdFrame& frame) {
  TARSUS_REQUIRE(!frame.color.pixels().empty(), "a picture is assessed where there is one");
  const Image<std::int32_t> f = luminance(frame.color);
  const auto sum = std::accumulate(f.pixels().begin(), f.pixels().end(), std::int64_t{0});
  const auto steps = static_cast<double>(f.pixels().size()) * kLevel;
  return {.frame_index = frame.index,
          .timestamp = frame.timestamp,
          .blur = blurOf(f),
          .brightness = static_cast<double>(sum) / steps};
}

}  // namespace tarsus
