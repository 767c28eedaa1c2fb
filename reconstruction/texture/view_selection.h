#pragma once

#include "reconstruction/texture/keyframe_coverage.h"
#include "reconstruction/texture/keyframes.h"

#include <span>
#include <vector>

namespace tarsus {

/// A place from which a picture was taken, and how far the picture can be trusted.
struct ViewCandidate {
  RigidTransform scan_from_camera = RigidTransform::Identity();
  double trust = 1.0;  ///< in (0, 1]: sharp and evenly exposed against those around it
};

struct SelectedView {
  int candidate = 0;
  KeyframeReason reason = KeyframeReason::Spread;
};

/// Greedy choice: what a set of views shows grows less with each further view (it is submodular),
/// where taking the best next one is never far from the best set. Source: Nemhauser, Wolsey and
/// Fisher, Math. Programming 14, 1978.
/// @param candidates  in the order in which they were taken
/// @param coverage  a row per candidate; without vertices, poses alone decide
/// @return  in the order of choice
[[nodiscard]] std::vector<SelectedView> selectViews(std::span<const ViewCandidate> candidates,
                                                    const CoverageTable& coverage,
                                                    const KeyframeOptions& options);

}  // namespace tarsus
