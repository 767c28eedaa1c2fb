#include "reconstruction/capture/undistort.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

Intrinsics lens(double k1) {
  Intrinsics k{
      .width = 160, .height = 120, .fx_px = 150, .fy_px = 150, .cx_px = 79.5, .cy_px = 59.5};
  k.distortion[0] = k1;
  return k;
}

/// Where the pinhole pixel (u, v) lands on the distorted image, by Brown's formula.
Eigen::Vector2d distorted(const Intrinsics& k, double u, double v) {
  const double x = (u - k.cx_px) / k.fx_px;
  const double y = (v - k.cy_px) / k.fy_px;
  const double radial = 1.0 + k.distortion[0] * (x * x + y * y);
  return {k.fx_px * x * radial + k.cx_px, k.fy_px * y * radial + k.cy_px};
}

TEST(Undistort, WithoutDistortionNothingChanges) {
  DepthImage depth(160, 120);
  depth.at(3, 5) = 421.0F;
  const DepthImage same = Undistorter(lens(0.0)).apply(depth);
  EXPECT_TRUE(std::ranges::equal(same.pixels(), depth.pixels()));
}

TEST(Undistort, DepthComesFromTheDistortedPixel) {
  const Intrinsics k = lens(-0.15);
  DepthImage depth(160, 120);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      depth.at(u, v) = static_cast<float>(300 + u + 1000 * v);
    }
  }
  const DepthImage result = Undistorter(k).apply(depth);
  for (const auto& [u, v] : {std::pair{10, 12}, {150, 100}, {80, 60}, {40, 110}}) {
    const Eigen::Vector2d source = distorted(k, u, v);
    const auto expected =
        static_cast<float>(300 + std::lround(source.x()) + 1000 * std::lround(source.y()));
    EXPECT_EQ(result.at(u, v), expected) << u << ' ' << v;
  }
}

TEST(Undistort, ColorIsInterpolated) {
  const Intrinsics k = lens(-0.15);
  ColorImage color(160, 120);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      color.at(u, v) = {
          .r = static_cast<std::uint8_t>(u), .g = static_cast<std::uint8_t>(v), .b = 9};
    }
  }
  const ColorImage result = Undistorter(k).apply(color);
  for (const auto& [u, v] : {std::pair{20, 22}, {140, 100}, {80, 60}}) {
    const Eigen::Vector2d source = distorted(k, u, v);
    EXPECT_NEAR(result.at(u, v).r, source.x(), 0.6);  // rounding of both images
    EXPECT_NEAR(result.at(u, v).g, source.y(), 0.6);
    EXPECT_EQ(result.at(u, v).b, 9);
  }
}

}  // namespace
}  // namespace tarsus
