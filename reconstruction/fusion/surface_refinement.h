#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"
#include "reconstruction/capture/scan_archive.h"
#include "reconstruction/fusion/tsdf_volume.h"

namespace tarsus {

struct SurfaceRefinementOptions {
  int sweeps = 4;
  int full_sweeps = 2;     ///< the last ones see every frame; those before need not, they only
                           ///< bring vertices near
  double kernel_mm = 3.0;  ///< Tukey's, of the first sweep; 0.7 of it with each, down to ...
  double least_kernel_mm = 1.25;
  double max_view_angle_deg = 72.0;
  double prior_observations = 2.0;  ///< the volume's own opinion counts as so many frames
  /// What fewer frames saw is taken away: this share of the tracked ones, but no more than
  /// `most_needed` and no fewer than 1. Such places are grazed by all who see them.
  double least_share_of_frames = 0.01;
  int most_needed = 6;
};

/// Puts each vertex, along its normal, to where all frames that see it measured the surface.
/// A voxel averages over a band and over what oblique rays extrapolate, so that the volume's
/// surface is fat on convex skin, rounded at rims and shallow in craters; here each frame is read
/// where its ray meets the vertex, and nothing is averaged but the frames. Also gives each vertex
/// its standard error (over at most 25 independent frames), its count of observations and, where
/// frames hold colour, their mean colour weighted by cos^2 of the incidence. Ours.
/// @errors Cancelled
[[nodiscard]] Expected<ExtractedSurface> refineSurface(ExtractedSurface surface,
                                                       const ScanArchive& frames,
                                                       const Trajectory& trajectory,
                                                       const SurfaceRefinementOptions& options,
                                                       const Job& job);

}  // namespace tarsus
