#include "reconstruction/texture/color_sampling.h"

#include <gtest/gtest.h>

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

TEST(ColorSampling, GradientIsTheTrueSlopePerPixel) {
  const IntensityGradient gradient = intensityGradient(ramp());
  // The ramp's luminance rises by these per pixel; an unnormalised Sobel would say eight times so.
  EXPECT_NEAR(gradient.du.at(9, 7), 0.299F * 4.0F + 0.114F * 2.0F, 1e-4F);
  EXPECT_NEAR(gradient.dv.at(9, 7), 0.587F * 5.0F + 0.114F * 3.0F, 1e-4F);
  EXPECT_EQ(gradient.du.at(0, 7), 0.0F);
}

}  // namespace
}  // namespace tarsus
