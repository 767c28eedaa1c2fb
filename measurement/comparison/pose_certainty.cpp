#include "measurement/comparison/pose_certainty.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// A model says no more than this about where its skin lies, however smooth it is; ours.
constexpr double kLeastResidual_mm = 0.05;
/// Errors of a fused surface move together at least over this area (reference_skin.h).
constexpr double kLeastCorrelation_mm2 = 14.0;
/// Share of the greatest information that counts as none.
constexpr double kNothing = 1e-5;

MotionVector rowOf(const SkinMatch& match, const Vector3d& normal, const Vector3d& center) {
  MotionVector row;
  row << (match.at_mm - center).cross(normal) / kMotionLever_mm, normal;
  return row;
}

/// Integral of the correlation of the gaps over the surface, up to where it first vanishes.
double correlationArea(std::span<const SkinMatch> matches, double variance_mm2) {
  constexpr double kBin_mm = 2.0;
  constexpr std::size_t kBins = 15;
  constexpr double kVanished = 0.05;
  std::array<double, kBins> products{};
  std::array<int, kBins> counts{};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double d = (matches[i].at_mm - matches[j].at_mm).norm();
      const auto bin = static_cast<std::size_t>(d / kBin_mm);
      if (bin < kBins) {
        products[bin] += matches[i].gap_mm * matches[j].gap_mm;
        ++counts[bin];
      }
    }
  }
  double area = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (counts[bin] == 0) {
      continue;  // nearer than samples lie
    }
    const double correlation = products[bin] / counts[bin] / variance_mm2;
    if (correlation < kVanished) {
      break;
    }
    const double inner = kBin_mm * static_cast<double>(bin);
    const double outer = inner + kBin_mm;
    area += std::numbers::pi * (outer * outer - inner * inner) * correlation;
  }
  return area;
}

}  // namespace

Eigen::Matrix<double, 3, 6> motionAt(const Vector3d& p_mm, const Vector3d& center_mm) {
  const Vector3d arm = (p_mm - center_mm) / kMotionLever_mm;
  Eigen::Matrix<double, 3, 6> motion;
  motion.leftCols<3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0;
  motion.rightCols<3>().setIdentity();
  return motion;
}

PoseCertainty certaintyOf(std::span<const SkinMatch> matches,
                          const Vector3d& center_mm,
                          double sample_area_mm2,
                          double reach_mm) {
  PoseCertainty certainty;
  MotionMatrix information = MotionMatrix::Zero();
  std::vector<SkinMatch> held;
  double squares = 0.0;
  double weights = 0.0;
  for (const SkinMatch& match : matches) {
    const double weight =
        match.kind == SkinMatch::Kind::Found ? tukeyWeight(match.gap_mm, reach_mm) : 0.0;
    if (weight > 0.0) {
      const MotionVector a = rowOf(match, match.normal_a, center_mm);
      const MotionVector b = rowOf(match, match.normal_b, center_mm);
      information += 0.5 * weight * (a * b.transpose() + b * a.transpose());
      squares += weight * match.gap_mm * match.gap_mm;
      weights += weight;
      held.push_back(match);
    }
  }
  const Eigen::SelfAdjointEigenSolver<MotionMatrix> solver(information);
  certainty.weakest = solver.eigenvectors().col(0);
  if (!(weights > 0.0) || !(solver.eigenvalues()[0] > kNothing * solver.eigenvalues()[5])) {
    return certainty;
  }
  const double variance = std::max(squares / weights, kLeastResidual_mm * kLeastResidual_mm);
  certainty.correlation_area_mm2 = std::max(kLeastCorrelation_mm2, correlationArea(held, variance));
  const double together = 2.0 * (1.0 + certainty.correlation_area_mm2 / sample_area_mm2);
  certainty.covariance = variance * together * information.inverse();
  certainty.determined = true;
  return certainty;
}

}  // namespace tarsus
