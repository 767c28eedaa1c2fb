#include "reconstruction/fusion/loop_measurement.h"

#include "reconstruction/base/require.h"
#include "reconstruction/fusion/visit_alignment.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// How well two visits can agree along a direction that all normals point to: what the field errs
/// by, common to many pixels, not their noise, which averages out. Ours.
constexpr double kAgreement_mm = 0.1;

/// The tracked frames about one, as long as the view stays much the same.
std::vector<std::size_t> windowAround(const Trajectory& trajectory,
                                      std::size_t middle,
                                      double range_mm,
                                      const LoopMeasureOptions& options) {
  std::vector<std::size_t> window{middle};
  const RigidTransform& view = *trajectory[middle].scan_from_camera;
  for (const int side : {-1, 1}) {
    int left = options.window_frames / 2;
    for (auto i = static_cast<std::ptrdiff_t>(middle) + side;
         left > 0 && i >= 0 && i < std::ssize(trajectory);
         i += side) {
      const auto& pose = trajectory[static_cast<std::size_t>(i)].scan_from_camera;
      if (!pose) {
        continue;
      }
      if (viewChange(view, *pose, range_mm) > options.window_view_change_rad) {
        break;
      }
      window.push_back(static_cast<std::size_t>(i));
      --left;
    }
  }
  std::ranges::sort(window);
  return window;
}

std::vector<VisitFrame> laterVisit(std::span<const FramePoints> points,
                                   const Trajectory& trajectory,
                                   std::span<const std::size_t> window,
                                   int most_points) {
  std::size_t count = 0;
  for (const std::size_t i : window) {
    count += points[i].size();
  }
  const std::size_t stride = strideFor(count, most_points);
  std::vector<VisitFrame> frames;
  for (const std::size_t i : window) {
    VisitFrame frame{.index = i, .scan_from_camera = *trajectory[i].scan_from_camera};
    for (std::size_t k = i % stride; k < points[i].size(); k += stride) {
      frame.points.push_back(points[i][k]);
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

double rmsWay(const RigidTransform& motion,
              const RigidTransform& scan_from_camera,
              const FramePoints& points) {
  double squares = 0.0;
  for (const AlignmentPoint& point : points) {
    const Eigen::Vector3d p = scan_from_camera * point.p_camera.cast<double>();
    squares += (motion * p - p).squaredNorm();
  }
  return std::sqrt(squares / std::max<double>(1.0, static_cast<double>(points.size())));
}

/// The same information in other axes.
MotionMatrix turned(const Eigen::Matrix3d& target_from_source, const MotionMatrix& information) {
  MotionMatrix turn = MotionMatrix::Zero();
  turn.topLeftCorner<3, 3>() = target_from_source;
  turn.bottomRightCorner<3, 3>() = target_from_source;
  return turn * information * turn.transpose();
}

}  // namespace

std::optional<Loop> measureLoop(const ScanArchive& frames,
                                std::span<const FramePoints> points,
                                const Trajectory& trajectory,
                                const FramePair& pair,
                                const LoopMeasureOptions& options) {
  TARSUS_REQUIRE(points.size() == trajectory.size() &&
                     static_cast<std::size_t>(frames.frameCount()) == trajectory.size(),
                 "points and a frame for each entry of the trajectory");
  const auto earlier = static_cast<std::size_t>(pair.earlier);
  const auto later = static_cast<std::size_t>(pair.later);
  TARSUS_REQUIRE(earlier < later && later < trajectory.size() &&
                     trajectory[earlier].scan_from_camera && trajectory[later].scan_from_camera,
                 "two frames with poses, one after the other");
  const RigidTransform& scan_from_later = *trajectory[later].scan_from_camera;
  const double range = viewingRange(points[later]);
  const VisitedPlace place(
      frames, trajectory, windowAround(trajectory, earlier, range, options), options);
  const auto window = windowAround(trajectory, later, range, options);
  const VisitAlignment aligned = alignVisit(
      place, laterVisit(points, trajectory, window, options.most_points), scan_from_later, options);
  if (aligned.inlier_fraction < options.least_inlier_fraction ||
      aligned.shared_fraction < options.least_shared_fraction) {
    return std::nullopt;
  }
  const RigidTransform scan_from_moved = aligned.motion * scan_from_later;
  return Loop{
      .earlier = pair.earlier,
      .later = pair.later,
      .earlier_from_later = trajectory[earlier].scan_from_camera->inverse() * scan_from_moved,
      .center_later = scan_from_later.inverse() * aligned.center,
      .information = turned(scan_from_moved.linear().transpose(), aligned.sensitivity) /
                     (kAgreement_mm * kAgreement_mm),
      .residual_mm = rmsWay(aligned.motion, scan_from_later, points[later]),
      .inlier_fraction = aligned.inlier_fraction,
      .shared_fraction = aligned.shared_fraction,
      .rmse_mm = aligned.rmse_mm,
      .free_directions = aligned.free_directions};
}

}  // namespace tarsus
