#pragma once

#include "reconstruction/scene/rigid_motion.h"

#include <cstddef>
#include <span>
#include <vector>

namespace tarsus {

/// What is known about one pose seen from another.
struct PoseEdge {
  std::size_t a = 0;  ///< positions in the list of poses
  std::size_t b = 0;
  RigidTransform a_from_b = RigidTransform::Identity();
  /// What b looks at, in its own frame [mm]: errors of a tracker are motions about this point.
  Eigen::Vector3d center_b = Eigen::Vector3d::Zero();
  /// S with S'S = information of the motion vector about the centre, in b's axes [1/mm].
  MotionMatrix sqrt_information = MotionMatrix::Identity();
  bool may_be_false = false;  ///< then it has a robust loss and is left out if nothing agrees
};

struct PoseGraphOptions {
  int max_iterations = 60;
  double robust_scale = 2.0;   ///< Cauchy's, in standard deviations
  double false_beyond = 10.0;  ///< an edge off by more standard deviations than this is false
};

/// Finds the poses that agree best with all edges; the first stays as it is. Doubtful edges pull
/// with Cauchy's loss from the poses as they are, so that what only one of them says and all others
/// deny stays open; those are left out of a second solution. One thread: the same bits always.
/// Sources: Lu and Milios, Autonomous Robots 1997 (pose graph); Agarwal et al., Ceres Solver.
/// @param start  scan_from_camera; connected by edges that are not doubtful
[[nodiscard]] std::vector<RigidTransform> solvePoseGraph(std::span<const RigidTransform> start,
                                                         std::span<const PoseEdge> edges,
                                                         const PoseGraphOptions& options);

}  // namespace tarsus
