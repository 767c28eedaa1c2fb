#pragma once

#include "measurement/wound/reference_skin.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace tarsus::test {

/// A rebuilt skin, as the benchmark asks for it.
struct FittedSkin {
  /// How far it lies above a point of the true skin, along the true normal [mm]; NaN: no fit.
  std::function<double(const Eigen::Vector3d& point, const Eigen::Vector3d& normal)> miss_mm;
  /// Standard deviation that it claims for its mean over these points [mm]; empty: claims nothing.
  std::function<double(std::span<const Eigen::Vector3d> points)> claimed_sd_mm;
};

/// One way to rebuild the skin over a wound; those that lost live here alone.
struct SkinCandidate {
  std::string name;
  /// @param samples  at least from the skin curve to kSamples_mm outside it; each candidate takes
  ///                 those that it wants
  std::function<FittedSkin(std::span<const SkinSample> samples, const Eigen::Vector3d& middle_mm)>
      fit;
};
inline constexpr double kSamples_mm = 20.0;

/// The default is the last.
[[nodiscard]] std::vector<SkinCandidate> skinCandidates();

}  // namespace tarsus::test
