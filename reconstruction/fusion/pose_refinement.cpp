#include "reconstruction/fusion/pose_refinement.h"

#include "reconstruction/fusion/pose_adjustment.h"
#include "reconstruction/fusion/vertex_view.h"

#include <algorithm>

namespace tarsus {
namespace {

/// Readings of a frame that take part, at most: more say little new, since neighbouring pixels err
/// alike.
constexpr std::size_t kMostVertices = 40'000;

/// Poses of the tracked frames, and which entries of the trajectory they are.
struct TrackedPoses {
  std::vector<std::size_t> entries;
  std::vector<RigidTransform> poses;
};

TrackedPoses trackedPoses(const Trajectory& trajectory) {
  TrackedPoses tracked;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (trajectory[i].scan_from_camera) {
      tracked.entries.push_back(i);
      tracked.poses.push_back(*trajectory[i].scan_from_camera);
    }
  }
  return tracked;
}

Expected<PoseRefinementResult> adjust(const Trajectory& trajectory,
                                      const TrackedPoses& tracked,
                                      const PoseRefinementOptions& options,
                                      const Job& job,
                                      PoseAdjustment& adjustment) {
  PoseRefinementResult result{.trajectory = trajectory};
  double kernel_mm = options.kernel_mm;
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    const double largest_mm = adjustment.sweep(kernel_mm);
    kernel_mm = std::max(0.5 * kernel_mm, options.least_kernel_mm);
    ++result.sweeps;
    job.report("refine poses", static_cast<double>(sweep + 1) / options.sweeps);
    if (largest_mm < options.stop_step_mm) {
      break;
    }
  }
  const RigidTransform anchor = tracked.poses.front() * adjustment.poses().front().inverse();
  for (std::size_t k = 0; k < tracked.entries.size(); ++k) {
    result.trajectory[tracked.entries[k]].scan_from_camera = anchor * adjustment.poses()[k];
  }
  result.trajectory[tracked.entries.front()].scan_from_camera = tracked.poses.front();
  result.refined_from_field = anchor;
  return result;
}

Eigen::Vector3d centerOf(const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    sum += p.cast<double>();
  }
  return sum / std::max(1.0, static_cast<double>(points.size()));
}

}  // namespace

Expected<PoseRefinementResult> refinePoses(const TsdfVolume& field,
                                           std::span<const FramePoints> points,
                                           const Trajectory& trajectory,
                                           const PoseRefinementOptions& options,
                                           const Job& job) {
  TARSUS_REQUIRE(points.size() == trajectory.size(), "points for each entry of the trajectory");
  const TrackedPoses tracked = trackedPoses(trajectory);
  if (tracked.poses.size() < 2) {
    return PoseRefinementResult{.trajectory = trajectory};
  }
  const auto observe = [&](std::size_t i, const RigidTransform& pose) {
    const Eigen::Isometry3f scan_from_camera = pose.cast<float>();
    std::vector<PoseObservation> seen;
    seen.reserve(points[tracked.entries[i]].size());
    for (const AlignmentPoint& point : points[tracked.entries[i]]) {
      if (const auto hit = meetSurface(field, scan_from_camera, point.p_camera)) {
        seen.push_back({.p = hit->p,
                        .normal = hit->normal,
                        .residual_mm = hit->residual_mm,
                        .weight = certaintyAt(point.p_camera.z()) * hit->cosine});
      }
    }
    return seen;
  };
  std::vector<Eigen::Vector3f> first_points;
  for (const AlignmentPoint& point : points[tracked.entries.front()]) {
    first_points.push_back((tracked.poses.front() * point.p_camera.cast<double>()).cast<float>());
  }
  PoseAdjustment adjustment(tracked.poses, centerOf(first_points), observe);
  return adjust(trajectory, tracked, options, job, adjustment);
}

Expected<PoseRefinementResult> refinePoses(const TriangleMesh& surface,
                                           const ScanArchive& frames,
                                           const Trajectory& trajectory,
                                           const PoseRefinementOptions& options,
                                           const Job& job) {
  TARSUS_REQUIRE(static_cast<std::size_t>(frames.frameCount()) == trajectory.size(),
                 "one pose for each frame");
  const TrackedPoses tracked = trackedPoses(trajectory);
  if (tracked.poses.size() < 2) {
    return PoseRefinementResult{.trajectory = trajectory};
  }
  const std::size_t stride = std::max<std::size_t>(1, surface.vertices.size() / kMostVertices);
  const auto observe = [&](std::size_t i, const RigidTransform& pose) {
    const RgbdFrame frame = frames.frame(static_cast<int>(tracked.entries[i]));
    const VertexView view(frames.camera().depth, frame.depth, pose, options.max_view_angle_deg);
    std::vector<PoseObservation> seen;
    for (std::size_t v = 0; v < surface.vertices.size(); v += stride) {
      if (const auto reading = view.read(surface.vertices[v], surface.normals[v])) {
        seen.push_back({.p = surface.vertices[v],
                        .normal = surface.normals[v],
                        .residual_mm = reading->height_mm,
                        .weight = certaintyAt(reading->depth_mm) * reading->cosine});
      }
    }
    return seen;
  };
  PoseAdjustment adjustment(tracked.poses, centerOf(surface.vertices), observe);
  return adjust(trajectory, tracked, options, job, adjustment);
}

}  // namespace tarsus
