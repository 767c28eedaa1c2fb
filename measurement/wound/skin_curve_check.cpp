#include "measurement/wound/skin_curve_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kStretches = 8;
constexpr double kStrip_mm = 3.0;
constexpr double kSteep = 0.12;
constexpr double kRaised_mm = 0.3;
constexpr double kSigmas = 3.0;

/// Sums over the samples of one stretch, weighted by their area.
struct Stretch {
  double area_mm2 = 0.0;
  double way = 0.0;
  double height = 0.0;
  double way_way = 0.0;
  double way_height = 0.0;
  double variance_area = 0.0;  ///< of the noise of single samples
  Eigen::Vector3d place = Eigen::Vector3d::Zero();

  void add(const SkinSample& s, double height_mm) {
    area_mm2 += s.area_mm2;
    way += s.area_mm2 * s.outside_mm;
    height += s.area_mm2 * height_mm;
    way_way += s.area_mm2 * s.outside_mm * s.outside_mm;
    way_height += s.area_mm2 * s.outside_mm * height_mm;
    variance_area += s.area_mm2 * s.sigma_mm * s.sigma_mm;
    place += s.area_mm2 * s.position_mm;
  }
  /// Of the ways about their mean.
  [[nodiscard]] double variance() const { return way_way / area_mm2 - std::pow(way / area_mm2, 2); }
  [[nodiscard]] UnevenSkin line() const {
    const double raised_mm = height / area_mm2;
    return {.at_mm = place / area_mm2,
            .slope = (way_height / area_mm2 - way / area_mm2 * raised_mm) / variance(),
            .raised_mm = raised_mm};
  }
  /// Standard deviation of the height, noise being one value each correlation area.
  [[nodiscard]] double uncertainty_mm(double correlation_area_mm2) const {
    return std::sqrt(variance_area / area_mm2 * correlation_area_mm2 / area_mm2);
  }
};

}  // namespace

std::vector<UnevenSkin> unevenAlongSkinCurve(std::span<const SkinSample> samples,
                                             const ReferenceSkin& skin,
                                             double correlation_area_mm2) {
  std::array<Stretch, kStretches> around;
  for (const SkinSample& s : samples) {
    if (s.outside_mm > kStrip_mm) {
      continue;
    }
    const ReferenceSkin::Foot foot = skin.footOf(s.position_mm);
    const double turn = std::atan2(foot.uv.y(), foot.uv.x()) / (2.0 * std::numbers::pi) + 0.5;
    const int stretch = std::clamp(static_cast<int>(turn * kStretches), 0, kStretches - 1);
    around[static_cast<std::size_t>(stretch)].add(s, -foot.depth_mm);
  }
  constexpr double kLeastVariance_mm2 = 0.2;  // a strip half as wide as meant
  std::vector<UnevenSkin> uneven;
  for (const Stretch& s : around) {
    if (!(s.area_mm2 > 0.0) || s.variance() < kLeastVariance_mm2) {
      continue;
    }
    const UnevenSkin line = s.line();
    const double noise_mm = kSigmas * s.uncertainty_mm(correlation_area_mm2);
    if (std::abs(line.slope) > std::max(kSteep, noise_mm / std::sqrt(s.variance())) ||
        line.raised_mm > std::max(kRaised_mm, noise_mm)) {
      uneven.push_back(line);
    }
  }
  return uneven;
}

}  // namespace tarsus
