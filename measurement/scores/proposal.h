#pragma once

#include "measurement/scores/scores.h"

#include <Eigen/Core>

namespace tarsus {

/// The opening area as a score's input, to be confirmed.
[[nodiscard]] ScoreItem<double> proposedArea(double opening_area_mm2);

/// Where on the foot a wound lies, by its place along the way from heel to toe, to be confirmed.
/// Borders at 0.33 and 0.50 of that way: our choice, near the joints of Chopart and Lisfranc. Where
/// the toes are amputated the way is too short and the proposal may lie too far forward.
/// @param wound_mm, heel_mm, toe_mm  in one frame
/// @return empty where heel and toe lie at one place
[[nodiscard]] ScoreItem<FootSite> proposedSite(const Eigen::Vector3d& wound_mm,
                                               const Eigen::Vector3d& heel_mm,
                                               const Eigen::Vector3d& toe_mm);

}  // namespace tarsus
