#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/fusion/fusion.h"

#include <vector>

namespace tarsus {

struct PoseRefinementOptions {
  int sweeps = 3;
  double kernel_mm = 4.0;            ///< Tukey's, of the first sweep; halved with each, down to ...
  double least_kernel_mm = 3.0;      ///< ... what keeps oblique readings, whose noise is 1 mm
  double stop_step_mm = 0.01;        ///< ends when no frame moves points by more
  double max_view_angle_deg = 72.0;  ///< of readings at a surface's vertices
};

struct PoseRefinementResult {
  Trajectory trajectory;  ///< first tracked pose as before, exactly
  /// The refined scan frame is pinned to the first camera; the field, or surface, was made around
  /// all of them.
  RigidTransform refined_from_field = RigidTransform::Identity();
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

/// The same against a surface: each frame is read at the surface's vertices. A surface whose
/// vertices were placed (refineSurface) has not the fat that a volume has on convex skin.
/// @param surface  with normals, scan frame [mm]
/// @errors Cancelled
[[nodiscard]] Expected<PoseRefinementResult> refinePoses(const TriangleMesh& surface,
                                                         const ScanArchive& frames,
                                                         const Trajectory& trajectory,
                                                         const PoseRefinementOptions& options,
                                                         const Job& job);

}  // namespace tarsus
