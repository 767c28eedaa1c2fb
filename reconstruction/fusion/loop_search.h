#pragma once

#include "reconstruction/fusion/fusion.h"

#include <span>
#include <vector>

namespace tarsus {

struct LoopSearchOptions {
  int most_loops = 6;  ///< each costs about 0.1 s to measure
  /// Least time between the two visits: this share of the tracked frames and so many frames (half
  /// of a scan shorter than twice that).
  double least_gap_share = 0.25;
  int least_gap_frames = 50;
  /// Views are the same up to this change [rad]: the larger of the angle between the optical axes
  /// and the camera's way over its distance from what it sees.
  double most_view_change_rad = 0.45;
  /// In between the camera must have been elsewhere: the views changed by at least this, and by so
  /// many times the change that is left. An arc that only goes on never comes back.
  double least_excursion_rad = 0.7;
  double least_excursion_ratio = 3.0;
  /// Share of either frame's cells that the other sees too; cells this large forgive drift.
  double least_overlap = 0.5;
  double cell_mm = 25.0;
};

/// Two frames that show the same place at different times.
struct FramePair {
  int earlier = 0;  ///< entries of the trajectory
  int later = 0;
  double overlap = 0.0;  ///< share of common cells of the points as posed, in [0, 1]
};

/// Where the path comes back to a view it had before, by the poses as they are: well spread pairs,
/// the best overlap of each neighbourhood. Ours.
/// @param points  per entry of the trajectory
/// @return  at most `most_loops` pairs, best first; empty where the path never comes back
[[nodiscard]] std::vector<FramePair> findLoops(const Trajectory& trajectory,
                                               std::span<const FramePoints> points,
                                               const LoopSearchOptions& options);

/// How much the view changed from one frame to another [rad]: the larger of the angle between the
/// optical axes and the camera's way over `range_mm`, its distance from what it sees.
[[nodiscard]] double viewChange(const RigidTransform& scan_from_a,
                                const RigidTransform& scan_from_b,
                                double range_mm);

/// Median depth of a frame's points [mm]; 0 where it has none.
[[nodiscard]] double viewingRange(const FramePoints& points);

}  // namespace tarsus
