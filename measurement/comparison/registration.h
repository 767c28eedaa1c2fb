#pragma once

#include "measurement/outline/outline.h"
#include "measurement/wound/measure.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/rigid_motion.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tarsus {

/// One visit as registration needs it; what is referred to must outlive it.
struct VisitSurface {
  const TexturedMesh& foot;
  const WoundOutline& outline;             ///< traced on this very model
  std::optional<Landmarks> landmarks;      ///< where toes begin, and a start
  std::span<const WoundOutline> left_out;  ///< callus and whatever else does not stay as it is
};

/// Bounds of clinical.md section 3; those that it does not give are ours.
struct RegistrationOptions {
  double skin_from_mm = 10.0;  ///< from the outline, along the surface
  double skin_to_mm = 60.0;
  double wound_margin_mm = 5.0;  ///< nothing is laid onto the other visit's wound and this around
  double toes_from_share = 0.8;  ///< of the way from heel to toe; ours: the web of the toes
  double most_rms_mm = 0.7;
  double least_inlier_fraction = 0.6;
  double inlier_mm = 2.0;         ///< farther from the other surface is no inlier; ours
  double most_slide_mm = 1.0;     ///< 95 % of what the pose may be wrong at the wound's edge; ours
  double least_cost_ratio = 1.5;  ///< another pose must fit this much worse; ours
};

/// The earlier visit laid onto the later one.
struct Registration {
  RigidTransform b_from_a = RigidTransform::Identity();
  double rms_residual_mm = 0.0;  ///< of the inliers, along the normals
  double inlier_fraction = 0.0;  ///< of the skin samples of both visits
  bool accepted = false;
  std::string refusal;    ///< one sentence that says what to do; empty where accepted
  double slide_mm = 0.0;  ///< 95 % at the wound's edge; infinite where the skin leaves it free
  /// Of the motion vector (rigid_motion.h) about `center_mm` in b's axes.
  MotionMatrix covariance = MotionMatrix::Zero();
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();

  /// Of where a point of a comes to lie in b, [mm^2].
  [[nodiscard]] Eigen::Matrix3d covarianceAt(const Eigen::Vector3d& p_b) const;
};

/// Lays a's skin onto b's: starts from the outlines, the landmarks and features of the skin, then
/// robust point-to-plane ICP in both directions. A pose that the skin does not hold in place, or
/// beside which another fits as well, is refused: a wrong map is worse than none.
/// Sources: Rusu et al., ICRA 2009 (features); Buch et al., ICRA 2013 (prerejection); Chen and
/// Medioni, IVC 10(3), 1992 (point to plane); Rusinkiewicz, ACM TOG 38(4), 2019 (both normals).
/// @errors OutlineInvalid, SurfaceIncomplete (no skin around the wound)
[[nodiscard]] Expected<Registration> registerVisits(const VisitSurface& a,
                                                    const VisitSurface& b,
                                                    const RegistrationOptions& options = {});

/// The same place in both visits, each in its own scan frame [mm].
struct PointPair {
  Eigen::Vector3d a_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_mm = Eigen::Vector3d::Zero();
};

/// Starts from pairs set by hand; accepted by the same rules, and only where the skin leaves the
/// pairs where they were set.
/// @param pairs  at least 3, not in a line
/// @errors BadOption, and those of registerVisits
[[nodiscard]] Expected<Registration> registerByPairs(const VisitSurface& a,
                                                     const VisitSurface& b,
                                                     std::span<const PointPair> pairs,
                                                     const RegistrationOptions& options = {});

}  // namespace tarsus
