#include "reconstruction/texture/exposure.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/exposure_fit.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tarsus {
namespace {

constexpr double kMaxLogGain = 0.69314718;
constexpr double kMaxBias = 30.0;  // grey levels
/// Weight, in shared points, of "the gain is 1": ties images together that share nothing.
constexpr double kPrior = 1.0;
constexpr std::size_t kFewestShared = 10;

using Ratios = std::vector<float>;  // log ratios of one pair of images in one channel

std::size_t pairIndex(std::size_t i, std::size_t j, std::size_t count) { return i * count + j; }

/// Log ratios of all pairs i < j that see a point in common.
std::vector<Ratios> pairRatios(std::span<const ExposureSample> samples,
                               std::size_t image_count,
                               int channel) {
  std::vector<Ratios> ratios(image_count * image_count);
  for (std::size_t a = 0; a < samples.size(); ++a) {
    const float first = samples[a].color[channel];
    for (std::size_t b = a + 1; b < samples.size() && samples[b].point == samples[a].point; ++b) {
      const float second = samples[b].color[channel];
      if (!isUsableLevel(first) || !isUsableLevel(second) || samples[a].image == samples[b].image) {
        continue;
      }
      const bool ordered = samples[a].image < samples[b].image;
      const float ratio = std::log(first / second);
      const auto low = std::min(samples[a].image, samples[b].image);
      const auto high = std::max(samples[a].image, samples[b].image);
      ratios[pairIndex(low, high, image_count)].push_back(ordered ? ratio : -ratio);
    }
  }
  return ratios;
}

double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Which images are joined by shared points, directly or through others: the lowest of them.
std::vector<int> groupsOf(const std::vector<Ratios>& ratios, std::size_t image_count) {
  std::vector<int> group(image_count);
  std::iota(group.begin(), group.end(), 0);
  for (std::size_t i = 0; i < image_count; ++i) {
    for (std::size_t j = i + 1; j < image_count; ++j) {
      if (ratios[pairIndex(i, j, image_count)].size() >= kFewestShared) {
        const int kept = std::min(group[i], group[j]);
        const int joined = std::max(group[i], group[j]);
        std::ranges::replace(group, joined, kept);
      }
    }
  }
  return group;
}

/// Least squares on log gains: sum n_ij (g_i - g_j - m_ij)^2 + prior sum g_i^2.
std::vector<Response> solveLogGains(std::vector<Ratios> ratios, std::size_t image_count) {
  const auto n = static_cast<Eigen::Index>(image_count);
  Eigen::MatrixXd normal = kPrior * Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n; ++j) {
      Ratios& pair =
          ratios[pairIndex(static_cast<std::size_t>(i), static_cast<std::size_t>(j), image_count)];
      if (pair.size() < kFewestShared) {
        continue;
      }
      const auto weight = static_cast<double>(pair.size());
      const double ratio = median(pair);
      normal(i, i) += weight;
      normal(j, j) += weight;
      normal(i, j) -= weight;
      normal(j, i) -= weight;
      right[i] += weight * ratio;
      right[j] -= weight * ratio;
    }
  }
  const Eigen::VectorXd log_gains = normal.ldlt().solve(right);
  std::vector<Response> responses(image_count);
  for (std::size_t i = 0; i < image_count; ++i) {
    responses[i].log_gain = log_gains[static_cast<Eigen::Index>(i)];
  }
  return responses;
}

/// The median image keeps its colours: a few views into the light must not shift all others.
std::vector<Response> solveChannel(std::span<const ExposureSample> samples,
                                   int channel,
                                   std::size_t image_count) {
  std::vector<Ratios> ratios = pairRatios(samples, image_count, channel);
  const std::vector<int> groups = groupsOf(ratios, image_count);
  std::vector<Response> responses = solveLogGains(std::move(ratios), image_count);
  anchorAtMedian(groups, responses);
  return fitBiases(samples, channel, groups, responses);
}

}  // namespace

std::vector<ColorGain> solveGains(std::span<const ExposureSample> samples, int image_count) {
  const auto count = static_cast<std::size_t>(image_count);
  std::vector<ColorGain> gains(count);
  parallelFor(3, [&](int channel) {
    const std::vector<Response> responses = solveChannel(samples, channel, count);
    for (std::size_t i = 0; i < count; ++i) {
      const double log_gain = std::clamp(responses[i].log_gain, -kMaxLogGain, kMaxLogGain);
      const double bias = std::clamp(responses[i].bias, -kMaxBias, kMaxBias);
      gains[i].gain[channel] = static_cast<float>(std::exp(log_gain));
      gains[i].bias[channel] = static_cast<float>(bias);
    }
  });
  return gains;
}

}  // namespace tarsus
