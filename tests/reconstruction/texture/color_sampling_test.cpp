#include "reconstruction/texture/color_sampling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

ColorImage ramp() {
  ColorImage image(20, 15);
  for (int v = 0; v < 15; ++v) {
    for (int u = 0; u < 20; ++u) {
      image.at(u, v) = {static_cast<std::uint8_t>(10 + 4 * u),
                        static_cast<std::uint8_t>(20 + 5 * v),
                        static_cast<std::uint8_t>(2 * u + 3 * v)};
    }
  }
  return image;
}

TEST(ColorSampling, BilinearIsExactOnARamp) {
  const ColorImage image = ramp();
  const Eigen::Vector3f color = sampleColor(image, 7.25F, 3.5F);
  EXPECT_NEAR(color.x(), 39.0F, 1e-4F);
  EXPECT_NEAR(color.y(), 37.5F, 1e-4F);
  EXPECT_NEAR(color.z(), 25.0F, 1e-4F);
  EXPECT_NEAR(sampleColor(image, 0.0F, 0.0F).x(), 10.0F, 1e-4F);
}

TEST(ColorSampling, InsideLeavesRoomForTheFourPixels) {
  EXPECT_TRUE(insideForSampling(20, 15, 0.0F, 0.0F));
  EXPECT_TRUE(insideForSampling(20, 15, 18.99F, 13.99F));
  EXPECT_FALSE(insideForSampling(20, 15, 19.0F, 5.0F));
  EXPECT_FALSE(insideForSampling(20, 15, 5.0F, 14.0F));
  EXPECT_FALSE(insideForSampling(20, 15, -0.01F, 5.0F));
}

TEST(ColorSampling, BicubicIsExactOnARampAndAtPixels) {
  const ColorImage image = ramp();
  EXPECT_NEAR(sampleColorBicubic(image, 7.25F, 3.5F).x(), 39.0F, 1e-4F);
  EXPECT_NEAR(sampleColorBicubic(image, 7.25F, 3.5F).y(), 37.5F, 1e-4F);
  EXPECT_EQ(sampleColorBicubic(image, 6.0F, 5.0F), colorVector(image.at(6, 5)));
}

TEST(ColorSampling, BicubicKeepsMoreOfAFineWaveThanBilinear) {
  // Half way between pixels, a wave of 5 px keeps cos(pi / 5) = 0.81 under bilinear sampling, and
  // (9 cos(pi / 5) - cos(3 pi / 5)) / 8 = 0.95 under Catmull-Rom.
  ColorImage image(40, 8);
  for (int v = 0; v < 8; ++v) {
    for (int u = 0; u < 40; ++u) {
      const double wave = 128.0 + 100.0 * std::cos(2.0 * M_PI * (u - 20.5) / 5.0);
      image.at(u, v) = {static_cast<std::uint8_t>(std::lround(wave)), 0, 0};
    }
  }
  EXPECT_NEAR(sampleColor(image, 20.5F, 3.0F).x(), 128.0F + 80.9F, 1.0F);
  EXPECT_NEAR(sampleColorBicubic(image, 20.5F, 3.0F).x(), 128.0F + 94.9F, 1.0F);
}

TEST(ColorSampling, IntensityIsLevelledLuminance) {
  const ColorGain gain{.gain = {2.0F, 2.0F, 2.0F}, .bias = {4.0F, 4.0F, 4.0F}};
  const Image<float> intensity = intensityImage(ramp(), gain);
  EXPECT_NEAR(intensity.at(3, 2), (intensityOf({22.0F, 30.0F, 12.0F}) - 4.0F) / 2.0F, 1e-4F);
}

}  // namespace
}  // namespace tarsus
