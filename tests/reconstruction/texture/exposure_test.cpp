#include "reconstruction/texture/exposure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

/// A chain of images, each sharing points with the next two only.
std::vector<ExposureSample> chain(const std::vector<Eigen::Vector3f>& gains, int odd_every) {
  std::vector<ExposureSample> samples;
  for (std::uint32_t point = 0; point < 4000; ++point) {
    const std::uint32_t first = point % static_cast<std::uint32_t>(gains.size());
    for (std::uint32_t k = first; k < std::min<std::size_t>(first + 3, gains.size()); ++k) {
      const float level = 60.0F + static_cast<float>((point * 37U) % 90U);
      Eigen::Vector3f color = level * gains[k];
      if (odd_every > 0 && (point + k) % static_cast<std::uint32_t>(odd_every) == 0) {
        color *= 1.4F;  // a highlight in one image only
      }
      samples.push_back({.point = point, .image = k, .color = color});
    }
  }
  return samples;
}

std::vector<Eigen::Vector3f> driftingGains() {
  std::vector<Eigen::Vector3f> gains;
  for (int i = 0; i < 12; ++i) {
    const auto t = static_cast<float>(i);
    gains.emplace_back(
        std::exp(0.15F * std::sin(t)), std::exp(0.02F * t), std::exp(-0.1F * std::cos(0.7F * t)));
  }
  return gains;
}

/// Only ratios between images can be known; which one is 1 is a choice.
Eigen::Vector3f relative(const std::vector<Eigen::Vector3f>& gains, std::size_t i) {
  return gains[i].cwiseQuotient(gains[0]);
}

TEST(SolveGains, FindsTheGainsOfAChainOfImages) {
  const std::vector<Eigen::Vector3f> truth = driftingGains();
  const std::vector<Eigen::Vector3f> found = solveGains(chain(truth, 0), 12);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // The prior holds each gain by one point in about 600.
    EXPECT_LT((relative(found, i) - relative(truth, i)).cwiseAbs().maxCoeff(), 0.005F) << i;
  }
}

TEST(SolveGains, HighlightsDoNotPullThem) {
  const std::vector<Eigen::Vector3f> truth = driftingGains();
  const std::vector<Eigen::Vector3f> found = solveGains(chain(truth, 7), 12);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((relative(found, i) - relative(truth, i)).cwiseAbs().maxCoeff(), 0.01F) << i;
  }
}

TEST(SolveGains, TheMedianImageKeepsItsColours) {
  std::vector<Eigen::Vector3f> truth(9, Eigen::Vector3f::Ones());
  truth[3].setConstant(1.7F);  // two views into the light
  truth[4].setConstant(1.8F);
  const std::vector<Eigen::Vector3f> found = solveGains(chain(truth, 0), 9);
  EXPECT_NEAR(found[0].x(), 1.0F, 0.01F);
  EXPECT_NEAR(found[8].x(), 1.0F, 0.01F);
}

TEST(SolveGains, ImagesThatShareNothingKeepTheirColours) {
  const std::vector<Eigen::Vector3f> found = solveGains({}, 3);
  ASSERT_EQ(found.size(), 3U);
  for (const Eigen::Vector3f& gain : found) {
    EXPECT_EQ(gain, Eigen::Vector3f(1, 1, 1));
  }
}

TEST(SolveGains, ClippedPixelsAreNotAsked) {
  std::vector<ExposureSample> samples;
  for (std::uint32_t point = 0; point < 1000; ++point) {
    const bool clipped = point % 3 != 0;  // the majority, so that a median would follow them
    const float level = clipped ? 240.0F : 100.0F;
    samples.push_back({.point = point, .image = 0, .color = Eigen::Vector3f::Constant(level)});
    const float brighter = std::min(1.21F * level, 255.0F);
    samples.push_back({.point = point, .image = 1, .color = Eigen::Vector3f::Constant(brighter)});
  }
  const std::vector<Eigen::Vector3f> found = solveGains(samples, 2);
  EXPECT_NEAR(found[1].x() / found[0].x(), 1.21F, 0.005F);
}

}  // namespace
}  // namespace tarsus
