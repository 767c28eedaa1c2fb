#include "reconstruction/fusion/loop_closure.h"

#include "reconstruction/base/require.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace tarsus {
namespace {

/// S with S'S = information.
MotionMatrix rootOf(const MotionMatrix& information) {
  const Eigen::SelfAdjointEigenSolver<MotionMatrix> eigen(information);
  const MotionVector roots = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return roots.asDiagonal() * eigen.eigenvectors().transpose();
}

/// What the tracker said about each pose, seen from the one before it.
std::vector<PoseEdge> neighbourEdges(std::span<const RigidTransform> poses,
                                     const Eigen::Vector3d& center_camera,
                                     const LoopClosingOptions& options) {
  std::vector<PoseEdge> edges;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const RigidTransform a_from_b = poses[k - 1].inverse() * poses[k];
    const double motion = a_from_b.translation().norm() +
                          Eigen::AngleAxisd(a_from_b.linear()).angle() * kMotionLever_mm;
    const double sigma_mm = options.step_base_mm + options.step_share * motion;
    edges.push_back({.a = k - 1,
                     .b = k,
                     .a_from_b = a_from_b,
                     .center_b = center_camera,
                     .sqrt_information = MotionMatrix::Identity() / sigma_mm});
  }
  return edges;
}

PoseEdge edgeOf(const Loop& loop, const std::vector<std::size_t>& node_of) {
  return {.a = node_of.at(static_cast<std::size_t>(loop.earlier)),
          .b = node_of.at(static_cast<std::size_t>(loop.later)),
          .a_from_b = loop.earlier_from_later,
          .center_b = loop.center_later,
          .sqrt_information = rootOf(loop.information),
          .may_be_false = true};
}

}  // namespace

Expected<LoopReport> checkLoops(const ScanArchive& frames,
                                std::span<const FramePoints> points,
                                const Trajectory& trajectory,
                                const LoopOptions& options,
                                const Job& job) {
  LoopReport report;
  double squares = 0.0;
  for (const FramePair& pair : findLoops(trajectory, points, options.search)) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    if (auto loop = measureLoop(frames, points, trajectory, pair, options.measure)) {
      squares += loop->residual_mm * loop->residual_mm;
      report.loops.push_back(std::move(*loop));
    } else {
      ++report.unmeasured;
    }
  }
  if (!report.loops.empty()) {
    report.residual_mm = std::sqrt(squares / static_cast<double>(report.loops.size()));
  }
  return report;
}

Trajectory closeLoops(const Trajectory& trajectory,
                      std::span<const Loop> loops,
                      const LoopClosingOptions& options) {
  std::vector<std::size_t> tracked;
  std::vector<std::size_t> node_of(trajectory.size(), trajectory.size());
  std::vector<RigidTransform> poses;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (trajectory[i].scan_from_camera) {
      node_of[i] = tracked.size();
      tracked.push_back(i);
      poses.push_back(*trajectory[i].scan_from_camera);
    }
  }
  if (loops.empty() || tracked.size() < 2) {
    return trajectory;
  }
  std::vector<PoseEdge> edges = neighbourEdges(poses, loops.front().center_later, options);
  for (const Loop& loop : loops) {
    edges.push_back(edgeOf(loop, node_of));
    TARSUS_REQUIRE(edges.back().a < poses.size() && edges.back().b < poses.size(),
                   "loops join frames with poses");
  }
  const std::vector<RigidTransform> closed = solvePoseGraph(poses, edges, options.graph);
  Trajectory result = trajectory;
  for (std::size_t k = 1; k < tracked.size(); ++k) {
    result[tracked[k]].scan_from_camera = closed[k];
  }
  return result;
}

}  // namespace tarsus
