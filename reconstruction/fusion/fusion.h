#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/capture/scan_archive.h"
#include "reconstruction/fusion/align.h"
#include "reconstruction/fusion/tsdf_volume.h"

namespace tarsus {

struct TrackingOptions {
  double voxel_size_mm = 2.0;
  TsdfWeighting weighting = TsdfWeighting::tracking();
  double coarse_voxel_size_mm = 4.0;  ///< the first iterations run on a wide band, for large steps
  double coarse_delta_mm = 28.0;
  double lost_rmse_mm = 2.5;          ///< above: lost (prototype: <= 1.2 good, >= 3.4 lost)
  double lost_inlier_fraction = 0.4;  ///< below: lost
  double min_depth_mm = 100.0;        ///< nearer or farther depth is not looked at
  double max_depth_mm = 1500.0;
  double max_depth_ratio = 2.0;  ///< as TsdfOptions
};

/// Points of a frame that took part in finding its pose, in its camera's frame.
using FramePoints = std::vector<AlignmentPoint>;

/// A scan after its first pass.
struct TrackedScan {
  Trajectory trajectory;  ///< one entry for each frame read
  int frames_tracked = 0;
  int relocalisations = 0;
  double rmse_mm = 0.0;             ///< root mean square of the residuals over all tracked frames
  TsdfVolume model;                 ///< the field that was tracked on
  std::vector<FramePoints> points;  ///< per entry of the trajectory
  ScanArchive archive;              ///< the frames, in the order of the trajectory
};

/// First stage: follows the camera by Gauss-Newton on the signed distance field,
/// E = sum V(T v_p)^2, and fuses each tracked frame into it. A lost frame is never fused. The
/// first tracked pose is the identity.
/// Source: Bylow et al., RSS 2013; the paper's section "Camera Pose Estimation".
/// @errors ScanEmpty, TrackingLost (fewer than half of the frames), Cancelled, those of the source
[[nodiscard]] Expected<TrackedScan> trackScan(FrameSource& frames,
                                              const TrackingOptions& options,
                                              const Job& job);

/// The same where the poses are known (a rig's encoders): by nearest time within half a frame;
/// frames without one count as lost.
/// @errors TrajectoryInvalid where no frame has a pose, ScanEmpty, Cancelled, those of the source
[[nodiscard]] Expected<TrackedScan> placeScan(FrameSource& frames,
                                              const Trajectory& known,
                                              const TrackingOptions& options,
                                              const Job& job);

/// Second stage: fuses all tracked frames anew with a narrow weighting, for sharp edges.
/// @param near  if there are any points [mm, scan frame], only what lies about them
/// @errors ScanEmpty where no frame has a pose, Cancelled
[[nodiscard]] Expected<TsdfVolume> fuseScan(const ScanArchive& frames,
                                            const Trajectory& trajectory,
                                            std::span<const Eigen::Vector3f> near,
                                            const TsdfOptions& options,
                                            const Job& job);

}  // namespace tarsus
