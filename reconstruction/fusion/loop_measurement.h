#pragma once

#include "reconstruction/fusion/loop_search.h"
#include "reconstruction/fusion/pose_graph.h"

#include <optional>

namespace tarsus {

struct LoopMeasureOptions {
  int window_frames = 11;                ///< on either side of the loop, less where ...
  double window_view_change_rad = 0.12;  ///< ... the view changes by more to either side
  /// Of the later window, in the first steps and in the last: noise falls with their number.
  int most_points_at_first = 8000;
  int most_points = 80000;
  double voxel_size_mm = 2.0;  ///< the tracker's
  TsdfWeighting weighting = TsdfWeighting::tracking();
  double coarse_voxel_size_mm = 4.0;  ///< the first steps run on a wide band, as in tracking
  TsdfWeighting coarse_weighting = {.epsilon_mm = 6.0, .delta_mm = 28.0, .sigma_per_mm2 = 0.005};
  double min_depth_mm = 100.0;  ///< as TrackingOptions
  double max_depth_mm = 1500.0;
  double max_depth_ratio = 2.0;
  double inlier_mm = 1.5;               ///< four times the noise of a pixel
  double least_inlier_fraction = 0.6;   ///< below, the two visits do not fit each other
  double least_shared_fraction = 0.25;  ///< of the later points, on the earlier's surface
};

/// Two visits of one place, and where the later one ought to lie, seen from the earlier.
struct Loop {
  int earlier = 0;  ///< entries of the trajectory
  int later = 0;
  RigidTransform earlier_from_later = RigidTransform::Identity();  ///< as measured
  Eigen::Vector3d center_later = Eigen::Vector3d::Zero();  ///< motions are about it, later camera
  /// Of the motion vector about the centre, in the later camera's axes [1/mm^2]; nothing along
  /// directions that the surface leaves free.
  MotionMatrix information = MotionMatrix::Zero();
  double residual_mm = 0.0;      ///< RMS way of the later frame's points to where they ought to lie
  double inlier_fraction = 0.0;  ///< of the points with a surface near them
  double shared_fraction = 0.0;  ///< of all points, those with a surface near them
  double rmse_mm = 0.0;          ///< of the points to the surface, once aligned
  int free_directions = 0;       ///< of the 6
};

/// Measures one loop on its own: a small field from the frames around the earlier visit, and the
/// points around the later one aligned to it as one rigid body, first by the field's values on a
/// wide band, at last where the pixels' rays meet the surface (align.h).
/// @param points  per entry of the trajectory
/// @return  nothing where the two do not fit each other
[[nodiscard]] std::optional<Loop> measureLoop(const ScanArchive& frames,
                                              std::span<const FramePoints> points,
                                              const Trajectory& trajectory,
                                              const FramePair& pair,
                                              const LoopMeasureOptions& options);

}  // namespace tarsus
