#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/scene/frame.h"

namespace tarsus {

struct BackgroundOptions {
  double plane_distance_mm = 4.0;      ///< nearer to a support plane counts as part of it
  double plane_angle_deg = 20.0;       ///< and its normal differs by less than this
  double min_plane_area_mm2 = 4000.0;  ///< a smaller flat patch is no support (a heel pad, a palm)
  int max_planes = 5;                  ///< bench, its edge, wall, floor, one more
  double cluster_gap_mm = 8.0;         ///< parts of one object may lie this far apart
};

struct ForegroundResult {
  ExtractedSurface surface;
  int planes_removed = 0;
  bool told_apart = false;  ///< false: nothing was cut
};

/// Keeps the object above the support plane nearest the optical axis over all frames: large planes
/// that have the rest of the scene before them (support, wall) are cut off, then the cluster that
/// the cameras looked at is kept.
/// @param surface     scan frame [mm], normals outward
/// @param trajectory  where the cameras were; they look along +z
[[nodiscard]] ForegroundResult removeBackground(const ExtractedSurface& surface,
                                                const Trajectory& trajectory,
                                                const BackgroundOptions& options = {});

}  // namespace tarsus
