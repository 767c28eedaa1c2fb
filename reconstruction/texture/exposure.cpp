#include "reconstruction/texture/exposure.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

constexpr float kDarkest = 8.0F;      // below, noise and rounding rule the ratio
constexpr float kBrightest = 245.0F;  // above, the sensor may have clipped
constexpr double kMaxLogGain = 0.69314718;
/// Weight, in shared points, of "the gain is 1": ties images together that share nothing.
constexpr double kPrior = 1.0;
constexpr std::size_t kFewestShared = 10;

using Ratios = std::vector<float>;  // log ratios of one pair of images in one channel

std::size_t pairIndex(std::size_t i, std::size_t j, std::size_t count) { return i * count + j; }

bool usable(float value) { return value >= kDarkest && value <= kBrightest; }

/// Log ratios of all pairs i < j that see a point in common.
std::vector<Ratios> pairRatios(std::span<const ExposureSample> samples,
                               std::size_t image_count,
                               int channel) {
  std::vector<Ratios> ratios(image_count * image_count);
  for (std::size_t a = 0; a < samples.size(); ++a) {
    const float first = samples[a].color[channel];
    for (std::size_t b = a + 1; b < samples.size() && samples[b].point == samples[a].point; ++b) {
      const float second = samples[b].color[channel];
      if (!usable(first) || !usable(second) || samples[a].image == samples[b].image) {
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

/// Least squares on log gains: sum n_ij (g_i - g_j - m_ij)^2 + prior sum g_i^2.
Eigen::VectorXd solveChannel(std::vector<Ratios> ratios, std::size_t image_count) {
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
  Eigen::VectorXd gains = normal.ldlt().solve(right);
  // The median image keeps its colours: a few views into the light must not shift all others.
  std::vector<float> sorted(gains.size());
  std::transform(gains.begin(), gains.end(), sorted.begin(), [](double gain) {
    return static_cast<float>(gain);
  });
  gains.array() -= median(sorted);
  return gains.cwiseMax(-kMaxLogGain).cwiseMin(kMaxLogGain);
}

}  // namespace

std::vector<Eigen::Vector3f> solveGains(std::span<const ExposureSample> samples, int image_count) {
  const auto count = static_cast<std::size_t>(image_count);
  std::vector<Eigen::Vector3f> gains(count, Eigen::Vector3f::Ones());
  parallelFor(3, [&](int channel) {
    const Eigen::VectorXd log_gains = solveChannel(pairRatios(samples, count, channel), count);
    for (std::size_t i = 0; i < count; ++i) {
      gains[i][channel] = static_cast<float>(std::exp(log_gains[static_cast<Eigen::Index>(i)]));
    }
  });
  return gains;
}

}  // namespace tarsus
