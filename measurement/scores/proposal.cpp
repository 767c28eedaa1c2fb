#include "measurement/scores/proposal.h"

#include <cmath>

namespace tarsus {

ScoreItem<double> proposedArea(double opening_area_mm2) {
  constexpr double kCm2PerMm2 = 0.01;
  return ScoreItem<double>::proposed(opening_area_mm2 * kCm2PerMm2);
}

ScoreItem<FootSite> proposedSite(const Eigen::Vector3d& wound_mm,
                                 const Eigen::Vector3d& heel_mm,
                                 const Eigen::Vector3d& toe_mm) {
  constexpr double kMidfoot = 0.33;
  constexpr double kForefoot = 0.50;
  const Eigen::Vector3d way = toe_mm - heel_mm;
  const double along = (wound_mm - heel_mm).dot(way) / way.squaredNorm();
  if (!std::isfinite(along)) {
    return {};
  }
  return ScoreItem<FootSite>::proposed(along < kMidfoot    ? FootSite::Hindfoot
                                       : along < kForefoot ? FootSite::Midfoot
                                                           : FootSite::Forefoot);
}

}  // namespace tarsus
