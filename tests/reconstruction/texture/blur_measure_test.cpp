#include "reconstruction/texture/blur_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// Grey blocks of 1 to 16 px with hashed levels: sharp edges at many spacings, both directions.
ColorImage blocks(int width, int height) {
  ColorImage image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const int size = 1 << ((u / 64 + v / 64) % 5);
      auto key = static_cast<std::uint32_t>(u / size + 1000 * (v / size));
      for (int round = 0; round < 3; ++round) {
        key = (key ^ (key >> 15U)) * 2654435761U;
      }
      const auto level = static_cast<std::uint8_t>(key >> 24U);
      image.at(u, v) = {level, level, level};
    }
  }
  return image;
}

/// Mean over a box of 2 * half + 1 pixels along u, v or both (three passes: nearly Gaussian).
ColorImage boxBlur(const ColorImage& image, int half_u, int half_v) {
  ColorImage result(image.width(), image.height());
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      int sum = 0;
      for (int dv = -half_v; dv <= half_v; ++dv) {
        for (int du = -half_u; du <= half_u; ++du) {
          sum += image
                     .at(std::clamp(u + du, 0, image.width() - 1),
                         std::clamp(v + dv, 0, image.height() - 1))
                     .g;
        }
      }
      const auto level = static_cast<std::uint8_t>(sum / ((2 * half_u + 1) * (2 * half_v + 1)));
      result.at(u, v) = {level, level, level};
    }
  }
  return result;
}

/// The definition of the paper, word by word, with a real 9-tap filter: equation numbers as there.
double blurByDefinition(const ColorImage& image) {
  const auto f = [&](int u, int v) {
    const Rgb8 c =
        image.at(std::clamp(u, 0, image.width() - 1), std::clamp(v, 0, image.height() - 1));
    return (77.0 * c.r + 150.0 * c.g + 29.0 * c.b) / 256.0;
  };
  const auto low_pass = [&](int u, int v, bool vertical) {  // (1)
    double sum = 0.0;
    for (int k = -4; k <= 4; ++k) {
      sum += vertical ? f(u, v + k) : f(u + k, v);
    }
    return sum / 9.0;
  };
  double worst = 0.0;
  for (const bool vertical : {true, false}) {
    double sum_f = 0.0;
    double sum_v = 0.0;
    for (int v = 1; v < image.height(); ++v) {
      for (int u = 1; u < image.width(); ++u) {
        const int bu = vertical ? u : u - 1;
        const int bv = vertical ? v - 1 : v;
        const double d_f = std::abs(f(u, v) - f(bu, bv));  // (2)
        // At the border the filter's window is repeated outward, one pixel at a time.
        const double d_b = std::abs(low_pass(u, v, vertical) - low_pass(bu, bv, vertical));  // (3)
        sum_f += d_f;
        sum_v += std::max(0.0, d_f - d_b);  // (4)
      }
    }
    worst = std::max(worst, (sum_f - sum_v) / sum_f);  // (5), (6)
  }
  return worst;
}

TEST(BlurMeasure, AgreesWithTheDefinitionOfCrete) {
  const ColorImage sharp = blocks(160, 120);
  // Both are sums of the same numbers; only rounding of doubles differs.
  EXPECT_NEAR(blurMeasure(sharp), blurByDefinition(sharp), 1e-9);
  const ColorImage soft = boxBlur(sharp, 3, 1);
  EXPECT_NEAR(blurMeasure(soft), blurByDefinition(soft), 1e-9);
}

TEST(BlurMeasure, GrowsWithGaussianBlur) {
  ColorImage image = blocks(320, 240);
  double last = blurMeasure(image);
  EXPECT_GT(last, 0.0);
  for (int pass = 0; pass < 5; ++pass) {
    image = boxBlur(image, 1, 1);
    const double blur = blurMeasure(image);
    EXPECT_GT(blur, last + 0.005) << "pass " << pass;
    EXPECT_LE(blur, 1.0);
    last = blur;
  }
}

TEST(BlurMeasure, GrowsWithMotionBlurInEitherDirection) {
  const ColorImage sharp = blocks(320, 240);
  double last_u = blurMeasure(sharp);
  double last_v = last_u;
  for (const int half : {1, 2, 4}) {
    const double along_u = blurMeasure(boxBlur(sharp, half, 0));
    const double along_v = blurMeasure(boxBlur(sharp, 0, half));
    EXPECT_GT(along_u, last_u + 0.02) << half;
    EXPECT_GT(along_v, last_v + 0.02) << half;
    last_u = along_u;
    last_v = along_v;
  }
}

TEST(BlurMeasure, StaysBetweenZeroAndOne) {
  EXPECT_EQ(blurMeasure(ColorImage(64, 48)), 1.0);  // one colour: nothing in it is sharp
  EXPECT_EQ(blurMeasure(ColorImage()), 1.0);
  ColorImage checker(64, 48);
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      const auto level = static_cast<std::uint8_t>((u + v) % 2 * 255);
      checker.at(u, v) = {level, level, level};
    }
  }
  // Neighbours differ by 255, nine-tap means by at most 255 / 9.
  EXPECT_NEAR(blurMeasure(checker), 1.0 / 9.0, 0.02);
}

TEST(AssessPicture, NotesBlurBrightnessAndWhichFrame) {
  RgbdFrame frame;
  frame.index = 12;
  frame.timestamp = std::chrono::microseconds(400'000);
  frame.color = blocks(320, 200);
  const PictureQuality quality = assessPicture(frame);
  EXPECT_EQ(quality.frame_index, 12);
  EXPECT_EQ(quality.timestamp, frame.timestamp);
  EXPECT_EQ(quality.blur, blurMeasure(frame.color));
  double sum = 0.0;
  for (const Rgb8 c : frame.color.pixels()) {
    sum += c.g;
  }
  EXPECT_NEAR(quality.brightness, sum / static_cast<double>(frame.color.pixels().size()), 1e-9);
}

TEST(BlurMeasure, PicturesNarrowerThanTheFilterHaveOneToo) {
  for (const int width : {2, 5, 9, 10, 11}) {
    const ColorImage image = blocks(width, 12);
    EXPECT_NEAR(blurMeasure(image), blurByDefinition(image), 1e-12) << width;
  }
}

}  // namespace
}  // namespace tarsus
