#pragma once

#include "measurement/comparison/visit_skin.h"

#include <span>
#include <vector>

namespace tarsus {

/// A sample of one visit's skin and what lies there on the other; b's frame [mm].
struct SkinMatch {
  enum class Kind : std::uint8_t {
    Ignored,  ///< it lies on the other's wound, callus or toes: says nothing
    Missed,   ///< no surface near it, or one that faces elsewhere
    Found,
  };
  Kind kind = Kind::Missed;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();     ///< of a's skin, moved
  Eigen::Vector3d normal_a = Eigen::Vector3d::Zero();  ///< moved
  Eigen::Vector3d normal_b = Eigen::Vector3d::Zero();
  double gap_mm = 0.0;  ///< from a's skin to b's, along the mean of both normals
};

/// Which samples are looked at.
struct MatchEffort {
  int stride = 1;    ///< every so many samples
  bool both = true;  ///< a's samples on b's surface and b's on a's; else the first alone
  /// On the other's nearest sample and the plane there, in place of its surface: tens of times as
  /// fast, and near enough to sort out starts.
  bool rough = false;
};

/// @return  a's samples, then b's
[[nodiscard]] std::vector<SkinMatch> matchSkin(const VisitSkin& a,
                                               const VisitSkin& b,
                                               const RigidTransform& b_from_a,
                                               double reach_mm,
                                               const MatchEffort& effort = {});

/// Gauss-Newton steps, one for each reach: matches within it, with Tukey's weights of it. Ends
/// early where a step of the last reach moves nothing.
[[nodiscard]] RigidTransform refinePose(const VisitSkin& a,
                                        const VisitSkin& b,
                                        const RigidTransform& start,
                                        std::span<const double> reaches_mm,
                                        const MatchEffort& effort = {});

/// Tukey's weight, 1 at 0 and 0 from `reach` on.
[[nodiscard]] double tukeyWeight(double residual, double reach);

struct PoseQuality {
  double rms_mm = 0.0;           ///< of the inliers
  double inlier_fraction = 0.0;  ///< of all that are not ignored
  double counted_share = 0.0;    ///< of the samples that are not ignored
  double cost_mm2 = 0.0;         ///< mean squared gap, none more than the reach
};
[[nodiscard]] PoseQuality qualityOf(std::span<const SkinMatch> matches, double inlier_mm);

}  // namespace tarsus
