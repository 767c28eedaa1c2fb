#pragma once

#include "reconstruction/fusion/loop_measurement.h"

namespace tarsus {

struct LoopReport {
  /// RMS over the loops: how far the ends of the path are from meeting; empty without loops.
  std::optional<double> residual_mm;
  std::vector<Loop> loops;
  int unmeasured = 0;  ///< pairs that show the same place by their poses, but do not fit
};

struct LoopOptions {
  LoopSearchOptions search;
  LoopMeasureOptions measure;
};

struct LoopClosingOptions {
  /// What the tracker may err from frame to frame, one standard deviation: so much and this share
  /// of the motion (camera's way, and turn at 100 mm). Only ratios matter much. Ours.
  double step_base_mm = 0.1;
  double step_share = 0.1;
  PoseGraphOptions graph;
};

/// Finds and measures the loops of a path as it is.
/// @errors Cancelled
[[nodiscard]] Expected<LoopReport> checkLoops(const ScanArchive& frames,
                                              std::span<const FramePoints> points,
                                              const Trajectory& trajectory,
                                              const LoopOptions& options,
                                              const Job& job);

/// Spreads what the loops lack over the whole path: a graph of all tracked frames, tied to their
/// neighbours as the tracker saw them and to each other by the loops. A loop that the others deny
/// stays open. For ends that miss each other by more than refinePoses can pull together (1 mm).
/// @return  the first tracked pose as before, exactly; frames without a pose stay without
[[nodiscard]] Trajectory closeLoops(const Trajectory& trajectory,
                                    std::span<const Loop> loops,
                                    const LoopClosingOptions& options);

}  // namespace tarsus
