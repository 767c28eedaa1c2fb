#include "reconstruction/texture/exposure.h"

#include "reconstruction/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// Evenly spread over [-1, 1), the same everywhere.
float hashed(std::uint32_t key) {
  for (int round = 0; round < 3; ++round) {
    key = (key ^ (key >> 16U)) * 0x45d9f3bU;
  }
  return static_cast<float>(key >> 8U) * 0x1.0p-23F - 1.0F;
}

float levelOf(std::uint32_t point) { return 60.0F + static_cast<float>((point * 37U) % 90U); }

struct Disturbance {
  int odd_every = 0;          ///< a highlight in one image only
  float noise_levels = 0.0F;  ///< greatest
};

/// A chain of images, each sharing points with the next two only.
std::vector<ExposureSample> chain(const std::vector<ColorGain>& gains,
                                  const Disturbance& disturbance = {},
                                  std::uint32_t points = 4000) {
  std::vector<ExposureSample> samples;
  for (std::uint32_t point = 0; point < points; ++point) {
    const std::uint32_t first = point % static_cast<std::uint32_t>(gains.size());
    for (std::uint32_t k = first; k < std::min<std::size_t>(first + 3, gains.size()); ++k) {
      Eigen::Vector3f color = levelOf(point) * gains[k].gain + gains[k].bias;
      const auto odd_every = static_cast<std::uint32_t>(disturbance.odd_every);
      if (odd_every > 0 && (point + k) % odd_every == 0) {
        color *= 1.4F;
      }
      for (std::uint32_t c = 0; c < 3; ++c) {
        color[c] += disturbance.noise_levels * hashed(point * 64 + k * 4 + c);
      }
      samples.push_back({.point = point, .image = k, .color = color});
    }
  }
  return samples;
}

std::vector<ColorGain> driftingGains() {
  std::vector<ColorGain> gains(12);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const auto t = static_cast<float>(i);
    gains[i].gain = {
        std::exp(0.15F * std::sin(t)), std::exp(0.02F * t), std::exp(-0.1F * std::cos(0.7F * t))};
  }
  return gains;
}

std::vector<ColorGain> withBiases(std::vector<ColorGain> gains) {
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const auto t = static_cast<float>(i);
    gains[i].bias = {
        15.0F * std::sin(2.0F * t), 14.0F * std::cos(1.3F * t), 13.0F * std::sin(0.9F * t)};
  }
  return gains;
}

/// How far levelled images are from each other over the range of levels, at most [grey levels]:
/// only this can be known, which image is right is a choice.
float disagreement(const std::vector<ColorGain>& truth, const std::vector<ColorGain>& found) {
  float most = 0.0F;
  for (const float level : {70.0F, 105.0F, 140.0F}) {
    Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F);
    Eigen::Vector3f high = -low;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Eigen::Vector3f leveled = found[i].leveled(level * truth[i].gain + truth[i].bias);
      low = low.cwiseMin(leveled);
      high = high.cwiseMax(leveled);
    }
    most = std::max(most, (high - low).maxCoeff());
  }
  return most;
}

float greatestBias(const std::vector<ColorGain>& gains) {
  float most = 0.0F;
  for (const ColorGain& gain : gains) {
    most = std::max(most, gain.bias.cwiseAbs().maxCoeff());
  }
  return most;
}

TEST(SolveGains, FindsTheGainsOfAChainOfImages) {
  const std::vector<ColorGain> truth = driftingGains();
  const std::vector<ColorGain> found = solveGains(chain(truth), 12);
  // The prior holds each gain by one point in about 600.
  EXPECT_LT(disagreement(truth, found), 0.7F);
  EXPECT_EQ(greatestBias(found), 0.0F);  // none is needed
}

TEST(SolveGains, FindsGainsAndBiases) {
  const std::vector<ColorGain> truth = withBiases(driftingGains());
  EXPECT_LT(disagreement(truth, solveGains(chain(truth), 12)), 0.5F);
  EXPECT_LT(disagreement(truth, solveGains(chain(truth, {.noise_levels = 3.0F}), 12)), 2.0F);
  EXPECT_GT(disagreement(truth, std::vector<ColorGain>(12)), 30.0F);
}

TEST(SolveGains, AddsNoBiasWhereNoiseAloneIsLeft) {
  const auto found = solveGains(chain(driftingGains(), {.noise_levels = 6.0F}), 12);
  EXPECT_EQ(greatestBias(found), 0.0F);
}

TEST(SolveGains, TenPerCentOfHighlightsDoNotMatter) {
  const Disturbance highlights{.odd_every = 10, .noise_levels = 2.0F};
  const std::vector<ColorGain> gains = driftingGains();
  EXPECT_LT(disagreement(gains, solveGains(chain(gains, highlights), 12)), 1.5F);
  const std::vector<ColorGain> biased = withBiases(gains);
  EXPECT_LT(disagreement(biased, solveGains(chain(biased, highlights), 12)), 2.0F);
}

TEST(SolveGains, TheMedianImageKeepsItsColours) {
  std::vector<ColorGain> truth(9);
  truth[3].gain.setConstant(1.7F);  // two views into the light
  truth[4].gain.setConstant(1.8F);
  const std::vector<ColorGain> found = solveGains(chain(truth), 9);
  EXPECT_NEAR(found[0].gain.x(), 1.0F, 0.01F);
  EXPECT_NEAR(found[8].gain.x(), 1.0F, 0.01F);
}

TEST(SolveGains, ColoursDoNotDrift) {
  const std::vector<ColorGain> truth = withBiases(driftingGains());
  const std::vector<ColorGain> found = solveGains(chain(truth), 12);
  for (int c = 0; c < 3; ++c) {
    std::vector<float> gains;
    std::vector<float> offsets;
    for (const ColorGain& own : found) {
      gains.push_back(own.gain[c]);
      offsets.push_back(own.bias[c] / own.gain[c]);
    }
    std::ranges::sort(gains);
    std::ranges::sort(offsets);
    // The middle two of twelve stand on both sides of the anchor.
    EXPECT_LE(gains[5], 1.0001F);
    EXPECT_GE(gains[6], 0.9999F);
    EXPECT_LE(offsets[5], 0.001F);
    EXPECT_GE(offsets[6], -0.001F);
  }
}

TEST(SolveGains, ImagesThatShareNothingKeepTheirColours) {
  for (const ColorGain& own : solveGains({}, 3)) {
    EXPECT_EQ(own.gain, Eigen::Vector3f(1, 1, 1));
    EXPECT_EQ(own.bias, Eigen::Vector3f(0, 0, 0));
  }
  std::vector<ColorGain> truth(9);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i].gain.setConstant(1.0F + 0.05F * static_cast<float>(i));
  }
  const std::vector<ColorGain> found = solveGains(chain(truth), 11);  // two more, seen by nobody
  EXPECT_EQ(found[9].gain, Eigen::Vector3f(1, 1, 1));
  EXPECT_EQ(found[10].gain, Eigen::Vector3f(1, 1, 1));
}

TEST(SolveGains, AFewSharedPointsGiveNoWildBias) {
  const std::vector<ColorGain> truth = withBiases(driftingGains());
  for (const std::uint32_t points : {20U, 150U, 400U}) {
    const auto found = solveGains(chain(truth, {.noise_levels = 5.0F}, points), 12);
    EXPECT_EQ(greatestBias(found), 0.0F) << points;
    for (const ColorGain& own : found) {
      EXPECT_GT(own.gain.minCoeff(), 0.6F);
      EXPECT_LT(own.gain.maxCoeff(), 1.6F);
    }
  }
}

TEST(SolveGains, OneLevelAloneCannotTellGainFromBias) {
  std::vector<ExposureSample> samples;
  for (std::uint32_t point = 0; point < 2000; ++point) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      const float level = 100.0F + 6.0F * static_cast<float>(k) + 2.0F * hashed(point * 8 + k);
      samples.push_back({.point = point, .image = k, .color = Eigen::Vector3f::Constant(level)});
    }
  }
  const std::vector<ColorGain> found = solveGains(samples, 4);
  for (std::size_t k = 0; k < 4; ++k) {
    const float level = 100.0F + 6.0F * static_cast<float>(k);
    EXPECT_NEAR(found[k].leveled(Eigen::Vector3f::Constant(level)).x(), 109.0F, 4.0F);
    EXPECT_LT(std::abs(found[k].bias.x()), 15.0F);
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
  const std::vector<ColorGain> found = solveGains(samples, 2);
  EXPECT_NEAR(found[1].gain.x() / found[0].gain.x(), 1.21F, 0.005F);
}

TEST(SolveGains, TheSameBitsOnOneThread) {
  const auto samples = chain(withBiases(driftingGains()), {.odd_every = 9, .noise_levels = 3.0F});
  const std::vector<ColorGain> many = solveGains(samples, 12);
  const ThreadLimit one(1);
  const std::vector<ColorGain> alone = solveGains(samples, 12);
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].gain, alone[i].gain);
    EXPECT_EQ(many[i].bias, alone[i].bias);
  }
}

}  // namespace
}  // namespace tarsus
