#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/fusion/fusion.h"

#include <vector>

namespace tarsus {

struct PoseRefinementOptions {
  int sweeps = 3;
  double kernel_mm = 3.0;        ///< Tukey's, of the first sweep; halved with each, down to ...
  double least_kernel_mm = 1.2;  ///< ... three times the noise of a pixel
  double stop_step_mm = 0.01;    ///< ends when no frame moves points by more
};

struct PoseRefinementResult {
  Trajectory trajectory;  ///< first tracked pose as before, exactly
  /// The refined scan frame is pinned to the first camera, and the field was made around them all.
  RigidTransform refined_from_field = RigidTransform::Identity();
  double rms_motion_mm = 0.0;  ///< how far points 100 mm about the scan's centre moved, RMS
  double residual_mm = 0.0;    ///< RMS of point to surface, at the end
  int sweeps = 0;
};

/// Moves all poses at once so that the frames agree with each other: bundle adjustment on depth.
/// The field gives the shape within small patches; how high each patch lies is an unknown of its
/// own, eliminated by Schur's complement, so that an early frame's error does not hold the later
/// ones. The reduced equations in the poses are solved by conjugate gradients.
/// Sources: Triggs et al., Bundle Adjustment, 2000 (elimination); Bylow et al., RSS 2013 (residual
/// on the field). The patches' heights as unknowns are ours.
/// @param points  per entry of the trajectory; those without pose are skipped
/// @errors Cancelled
[[nodiscard]] Expected<PoseRefinementResult> refinePoses(const TsdfVolume& field,
                                                         std::span<const FramePoints> points,
                                                         const Trajectory& trajectory,
                                                         const PoseRefinementOptions& options,
                                                         const Job& job);

}  // namespace tarsus
