#pragma once

#include "measurement/comparison/visit_skin.h"

#include <span>
#include <vector>

namespace tarsus {

/// The outlines laid on one another, turned about the skin's normal in equal steps: wherever the
/// wound is the same one, one of them lies near the truth.
[[nodiscard]] std::vector<RigidTransform> startsFromOutlines(const VisitSkin& a,
                                                             const VisitSkin& b);

/// Heel, toe and wound laid on one another; empty where a visit has no landmarks.
[[nodiscard]] std::vector<RigidTransform> startsFromLandmarks(const VisitSkin& a,
                                                              const VisitSkin& b);

/// Poses on which triples of alike places agree, the best supported first. Same bits each time.
/// Sources: Rusu et al., ICRA 2009 (FPFH); Buch et al., ICRA 2013 (sample consensus that rejects a
/// triple by the lengths of its sides before it is tried).
/// @errors SurfaceIncomplete (the features cannot be computed)
[[nodiscard]] Expected<std::vector<RigidTransform>> startsFromFeatures(const VisitSkin& a,
                                                                       const VisitSkin& b);

/// The rigid motion that brings a's points nearest to b's in the least squares.
/// Source: Umeyama, PAMI 13(4), 1991.
/// @param a, b  the same number, at least 3, not in a line
[[nodiscard]] RigidTransform fitPoints(std::span<const Eigen::Vector3d> a,
                                       std::span<const Eigen::Vector3d> b);

}  // namespace tarsus
