#include "reconstruction/capture/scan_archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace tarsus {
namespace {

RgbdCamera cameraOf(int width, int height, double units_per_m) {
  RgbdCamera camera;
  camera.depth.width = width;
  camera.depth.height = height;
  camera.depth_units_per_m = units_per_m;
  return camera;
}

/// As the reader of scan folders makes depth of the sensor's numbers.
float depthOf(std::uint16_t step, const RgbdCamera& camera) {
  return static_cast<float>(step * (1000.0 / camera.depth_units_per_m));
}

DepthImage depthFrom(const RgbdCamera& camera, const std::vector<std::uint16_t>& steps) {
  DepthImage depth(camera.depth.width, camera.depth.height);
  std::ranges::transform(
      steps, depth.pixels().begin(), [&](std::uint16_t step) { return depthOf(step, camera); });
  return depth;
}

DepthImage throughArchive(const RgbdCamera& camera, const DepthImage& depth) {
  ScanArchive archive(camera, 1);
  archive.add({.index = 0, .timestamp = {}, .depth = depth, .color = {}});
  return archive.frame(0).depth;
}

bool sameBits(const DepthImage& a, const DepthImage& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::ranges::equal(a.pixels(), b.pixels(), [](float x, float y) {
           return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
         });
}

void expectSameBits(const RgbdCamera& camera, const std::vector<std::uint16_t>& steps) {
  const DepthImage depth = depthFrom(camera, steps);
  EXPECT_TRUE(sameBits(throughArchive(camera, depth), depth));
}

constexpr int kWidth = 37;  // odd, so that rows end anywhere within runs
constexpr int kHeight = 23;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

TEST(ScanArchive, AnyNumbersOfTheSensorComeBackToTheBit) {
  std::mt19937 dice(3);
  for (const double units : {1000.0, 8000.0, 10000.0, 4000.0}) {
    const RgbdCamera camera = cameraOf(kWidth, kHeight, units);
    for (int round = 0; round < 20; ++round) {
      std::vector<std::uint16_t> steps(kPixels);
      for (std::uint16_t& step : steps) {  // every difference there may be, with and without holes
        step = dice() % 20U < static_cast<unsigned>(round) ? std::uint16_t{0}
                                                           : static_cast<std::uint16_t>(dice());
      }
      expectSameBits(camera, steps);
    }
  }
}

TEST(ScanArchive, SmoothDepthWithHolesComesBackInAFractionOfTheRoom) {
  const RgbdCamera camera = cameraOf(320, 240, 8000.0);
  std::mt19937 dice(4);
  std::vector<std::uint16_t> steps(std::size_t{320} * 240);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double u = static_cast<double>(i % 320);
    const double v = static_cast<double>(i / 320);
    const bool hole = std::hypot(u - 90.0, v - 60.0) < 30.0 || u > 290.0;
    const double z_steps = 3200.0 + 400.0 * std::sin(0.02 * u) + 2.0 * v;
    steps[i] = hole ? std::uint16_t{0}
                    : static_cast<std::uint16_t>(z_steps + static_cast<double>(dice() % 7U));
  }
  expectSameBits(camera, steps);
  ScanArchive archive(camera, 1);
  archive.add({.index = 0, .timestamp = {}, .depth = depthFrom(camera, steps), .color = {}});
  // Differences below 64 steps take one byte of the two that the sensor sends.
  EXPECT_LT(archive.memoryBytes(), steps.size() * 11 / 10);
}

TEST(ScanArchive, TheEdgesOfTheFormatComeBack) {
  const RgbdCamera camera = cameraOf(kWidth, kHeight, 8000.0);
  expectSameBits(camera, std::vector<std::uint16_t>(kPixels, 0));
  expectSameBits(camera, std::vector<std::uint16_t>(kPixels, 65535));
  std::vector<std::uint16_t> alternating(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) {
    alternating[i] = i % 2 == 0 ? 65535 : 1;  // the largest differences of either sign
  }
  expectSameBits(camera, alternating);
  for (const std::size_t at : {std::size_t{0}, std::size_t{1}, kPixels / 2, kPixels - 1}) {
    std::vector<std::uint16_t> single(kPixels, 0);
    single[at] = 65535;
    expectSameBits(camera, single);
    std::vector<std::uint16_t> missing(kPixels, 3200);
    missing[at] = 0;
    expectSameBits(camera, missing);
  }
  expectSameBits(cameraOf(1, 1, 1000.0), {700});
  expectSameBits(cameraOf(1, 1, 1000.0), {0});
}

TEST(ScanArchive, CorrectedDepthComesBackToHalfAStep) {
  const RgbdCamera camera = cameraOf(kWidth, kHeight, 8000.0);
  std::mt19937 dice(5);
  DepthImage depth(kWidth, kHeight);
  for (float& z : depth.pixels()) {
    z = dice() % 5U == 0 ? 0.0F : 100.0F + 0.000'000'4F * static_cast<float>(dice());
  }
  const DepthImage back = throughArchive(camera, depth);
  for (std::size_t i = 0; i < kPixels; ++i) {
    EXPECT_EQ(back.pixels()[i] == 0.0F, depth.pixels()[i] == 0.0F);
    // 1/64 mm, and one unit in the last place of a float at 2 m.
    EXPECT_NEAR(back.pixels()[i], depth.pixels()[i], 1.0F / 64.0F + 0.000'13F);
  }
}

TEST(ScanArchive, FramesKeepTheirOrderIndexAndTime) {
  const RgbdCamera camera = cameraOf(2, 2, 1000.0);
  ScanArchive archive(camera, 5);
  for (int i = 0; i < 5; ++i) {
    const auto step = static_cast<std::uint16_t>(300 + i);
    archive.add({.index = 3 * i + 1,
                 .timestamp = std::chrono::microseconds(33'333LL * i + 7),
                 .depth = depthFrom(camera, {step, step, 0, step}),
                 .color = {}});
  }
  ASSERT_EQ(archive.frameCount(), 5);
  for (const int i : {4, 0, 2, 3, 1}) {  // in any order
    const RgbdFrame frame = archive.frame(i);
    EXPECT_EQ(frame.index, 3 * i + 1);
    EXPECT_EQ(frame.timestamp.count(), 33'333LL * i + 7);
    EXPECT_EQ(frame.depth.at(0, 0), static_cast<float>(300 + i));
    EXPECT_EQ(frame.depth.at(0, 1), 0.0F);
    EXPECT_EQ(frame.color.width(), 0);
  }
}

/// Which of `count` frames keep their colour.
std::vector<int> framesWithColor(int expected, int count) {
  const RgbdCamera camera = cameraOf(2, 2, 1000.0);
  ScanArchive archive(camera, expected);
  RgbdFrame frame{
      .index = 0, .timestamp = {}, .depth = DepthImage(2, 2), .color = ColorImage(1, 1)};
  for (int i = 0; i < count; ++i) {
    frame.color.at(0, 0) = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 9};
    archive.add(frame);
  }
  std::vector<int> with;
  for (int i = 0; i < count; ++i) {
    const ColorImage& color = archive.color(i);
    if (color.width() > 0) {
      with.push_back(i);
      EXPECT_EQ(color.at(0, 0).r + 256 * color.at(0, 0).g, i);  // its own colour
    }
  }
  return with;
}

TEST(ScanArchive, ColoursAreFewAndSpreadEvenly) {
  for (const int count : {1, 2, 149, 150, 151, 299, 300, 301, 449, 600, 601, 1799}) {
    const std::vector<int> with = framesWithColor(count, count);
    EXPECT_LE(static_cast<int>(with.size()), ScanArchive::kMostColorImages) << count;
    EXPECT_GE(static_cast<int>(with.size()), std::min(count, ScanArchive::kMostColorImages / 2));
    ASSERT_FALSE(with.empty());
    EXPECT_EQ(with.front(), 0);
    for (std::size_t k = 2; k < with.size(); ++k) {
      EXPECT_EQ(with[k] - with[k - 1], with[1] - with[0]) << count;
    }
    if (with.size() > 1) {
      EXPECT_LT(count - 1 - with.back(), with[1] - with[0]) << count;  // as far as the end
    }
  }
}

}  // namespace
}  // namespace tarsus
