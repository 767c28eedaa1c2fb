#include "reconstruction/pipeline/contact_sheet.h"

#include <algorithm>
#include <array>

namespace tarsus {
namespace {

/// Where pixel i of a picture of `small` pixels begins in one of `large`.
int beginOf(int i, int small, int large) {
  return static_cast<int>(static_cast<std::int64_t>(i) * large / small);
}

/// Mean of the pixels that a pixel of the small picture covers.
Rgb8 meanOf(const ColorImage& image, const Eigen::Array2i& first, const Eigen::Array2i& last) {
  std::array<int, 3> sum{};
  for (int v = first.y(); v < last.y(); ++v) {
    for (int u = first.x(); u < last.x(); ++u) {
      const Rgb8 c = image.at(u, v);
      sum[0] += c.r;
      sum[1] += c.g;
      sum[2] += c.b;
    }
  }
  const int count = (last - first).prod();
  const auto level = [&](int s) { return static_cast<std::uint8_t>((s + count / 2) / count); };
  return {level(sum[0]), level(sum[1]), level(sum[2])};
}

void paint(const ColorImage& image, const Eigen::Array2i& at, int width, ColorImage& sheet) {
  const int height = width * image.height() / image.width();
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Array2i first(beginOf(u, width, image.width()),
                                 beginOf(v, height, image.height()));
      const Eigen::Array2i next(beginOf(u + 1, width, image.width()),
                                beginOf(v + 1, height, image.height()));
      sheet.at(at.x() + u, at.y() + v) = meanOf(image, first, next.max(first + 1));
    }
  }
}

}  // namespace

ColorImage contactSheet(std::span<const Keyframe> keyframes, const ContactSheetOptions& options) {
  if (keyframes.empty() || keyframes.front().frame.color.width() == 0) {
    return {};
  }
  const ColorImage& any = keyframes.front().frame.color;
  const int count = static_cast<int>(keyframes.size());
  const int columns = std::min(options.columns, count);
  const int rows = (count + columns - 1) / columns;
  const int width = std::min(options.picture_width_px, any.width());
  const int height = width * any.height() / any.width();
  const int gap = options.gap_px;
  ColorImage sheet(columns * (width + gap) + gap, rows * (height + gap) + gap);
  std::ranges::fill(sheet.pixels(), options.background);
  for (int i = 0; i < count; ++i) {
    const ColorImage& color = keyframes[static_cast<std::size_t>(i)].frame.color;
    if (color.width() == any.width() && color.height() == any.height()) {
      const Eigen::Array2i at(gap + i % columns * (width + gap),
                              gap + i / columns * (height + gap));
      paint(color, at, width, sheet);
    }
  }
  return sheet;
}

}  // namespace tarsus
