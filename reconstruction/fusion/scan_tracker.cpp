#include "reconstruction/fusion/scan_tracker.h"

#include "reconstruction/fusion/align.h"
#include "reconstruction/fusion/depth_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace tarsus {
namespace {

/// Fewer trusted pixels than this share of the image cannot hold a pose. Ours.
constexpr double kLeastValidShare = 0.01;
/// Poses kept to start from when all else fails, and how far apart they are.
constexpr double kKeyframeDistance_mm = 40.0;
constexpr double kKeyframeAngle_rad = 10.0 * std::numbers::pi / 180.0;
constexpr std::size_t kMaxKeyframes = 64;
constexpr std::size_t kKeyframesTried = 8;
/// After being lost, a pose is believed only when it is better than the usual limits.
constexpr double kReliefInlierFraction = 0.6;
constexpr double kReliefRmseShare = 0.7;
/// So good a fit needs no look at the coarse field.
constexpr double kNear_mm = 1.0;
constexpr double kNearInliers = 0.75;
/// The coarse field hardly changes from frame to frame: it gets one when the camera has moved.
constexpr double kCoarseStep_mm = 6.0;
constexpr double kCoarseStep_rad = 1.5 * std::numbers::pi / 180.0;
constexpr double kFewInliers = 0.2;
constexpr double kGoodShareOfKnown = 0.95;
/// A surface that leaves more directions free than this (a plane: 3) does not hold the camera.
constexpr int kMostFreeDirections = 2;

TsdfWeighting coarseWeighting(const TrackingOptions& options) {
  const double delta = options.coarse_delta_mm;
  const double epsilon = std::min(6.0, 0.25 * delta);
  const double fine_fall = options.weighting.delta_mm - options.weighting.epsilon_mm;
  const double ratio = fine_fall / std::max(1.0, delta - epsilon);
  return {.epsilon_mm = epsilon,
          .delta_mm = delta,
          .sigma_per_mm2 = options.weighting.sigma_per_mm2 * ratio * ratio};
}

TsdfOptions volumeOptions(const TrackingOptions& options,
                          double voxel_size_mm,
                          const TsdfWeighting& weighting) {
  TsdfOptions result;
  result.min_depth_mm = options.min_depth_mm;
  result.max_depth_mm = options.max_depth_mm;
  result.max_depth_ratio = options.max_depth_ratio;
  result.voxel_size_mm = voxel_size_mm;
  result.weighting = weighting;
  result.with_color = false;
  return result;
}

bool farApart(const RigidTransform& a, const RigidTransform& b, double mm, double rad) {
  const RigidTransform difference = a.inverse() * b;
  return difference.translation().norm() > mm ||
         Eigen::AngleAxisd(difference.linear()).angle() > rad;
}

}  // namespace

struct ScanTracker::State {
  State(const RgbdCamera& scan_camera, const TrackingOptions& tracking_options)
      : camera(scan_camera),
        options(tracking_options),
        coarse(volumeOptions(tracking_options,
                             tracking_options.coarse_voxel_size_mm,
                             coarseWeighting(tracking_options))),
        fine(volumeOptions(
            tracking_options, tracking_options.voxel_size_mm, tracking_options.weighting)) {}

  RgbdCamera camera;
  TrackingOptions options;
  TsdfVolume coarse;
  TsdfVolume fine;
  std::optional<RigidTransform> last_pose;      ///< of the last tracked frame
  std::optional<RigidTransform> previous_pose;  ///< of the frame before it, if that was tracked
  std::optional<RigidTransform> last_in_coarse;
  std::vector<RigidTransform> keyframes;
  bool lost = false;
  int relocalisations = 0;

  [[nodiscard]] AlignmentResult alignFrom(const PreparedFrame& points,
                                          const RigidTransform& start) const {
    const double delta = options.weighting.delta_mm;
    AlignmentResult result = alignToField(fine,
                                          points.few,
                                          start,
                                          {.max_iterations = 2,
                                           .kernel_mm = delta,
                                           .inlier_mm = options.lost_rmse_mm,
                                           .stop_step_mm = 0.3,
                                           .gradient_field = &coarse});
    if (result.rmse_mm > kNear_mm || result.inlier_fraction < kNearInliers) {
      result = alignToField(coarse,
                            points.few,
                            start,
                            {.max_iterations = 12,
                             .kernel_mm = options.coarse_delta_mm,
                             .inlier_mm = options.lost_rmse_mm,
                             .stop_step_mm = 0.5});
    }
    result = alignToField(fine,
                          points.some,
                          result.scan_from_camera,
                          {.max_iterations = 4,
                           .kernel_mm = delta,
                           .inlier_mm = options.lost_rmse_mm,
                           .stop_step_mm = 0.3,
                           .gradient_field = &coarse});
    return alignToField(fine,
                        points.many,
                        result.scan_from_camera,
                        {.max_iterations = 3,
                         .kernel_mm = std::clamp(3.0 * result.rmse_mm, 1.5, delta),
                         .inlier_mm = options.lost_rmse_mm,
                         .stop_step_mm = 0.06,
                         .gradient_field = &coarse});
  }

  [[nodiscard]] bool believable(const AlignmentResult& result, bool strict) const {
    const double rmse = options.lost_rmse_mm * (strict ? kReliefRmseShare : 1.0);
    const double share = strict ? std::max(kReliefInlierFraction, options.lost_inlier_fraction)
                                : options.lost_inlier_fraction;
    // Where depth is full of holes, so is the field at first: few points lie in it, all of them
    // well.
    const bool few_but_good = result.inlier_fraction >= kFewInliers &&
                              result.inlier_fraction >= kGoodShareOfKnown * result.known_fraction;
    return result.rmse_mm <= rmse && (result.inlier_fraction >= share || few_but_good) &&
           result.free_directions <= kMostFreeDirections;
  }

  /// Predicted pose first, then the last one, then the nearest keyframes.
  [[nodiscard]] std::vector<RigidTransform> starts() const {
    std::vector<RigidTransform> result;
    if (previous_pose && !lost) {
      result.push_back(*last_pose * (previous_pose->inverse() * *last_pose));
    }
    result.push_back(*last_pose);
    std::vector<RigidTransform> known = keyframes;
    std::stable_sort(known.begin(), known.end(), [&](const auto& a, const auto& b) {
      return (a.translation() - last_pose->translation()).squaredNorm() <
             (b.translation() - last_pose->translation()).squaredNorm();
    });
    known.resize(std::min(known.size(), kKeyframesTried));
    result.insert(result.end(), known.begin(), known.end());
    return result;
  }

  [[nodiscard]] AlignmentResult track(const PreparedFrame& points) const {
    AlignmentResult best;
    bool first = true;
    for (const RigidTransform& start : starts()) {
      const AlignmentResult result = alignFrom(points, start);
      // Only the first try of a frame that follows a tracked one may be believed at once.
      if (believable(result, lost || !first)) {
        return result;
      }
      if (first || result.inlier_fraction > best.inlier_fraction) {
        best = result;
      }
      first = false;
    }
    best.inlier_fraction = std::min(best.inlier_fraction, options.lost_inlier_fraction);
    best.rmse_mm = std::max(best.rmse_mm, options.lost_rmse_mm);
    best.cost_mm2 = -1.0;  // lost
    return best;
  }

  void fuse(const DepthPlanes& planes, const RigidTransform& pose) {
    if (!last_in_coarse || farApart(*last_in_coarse, pose, kCoarseStep_mm, kCoarseStep_rad)) {
      coarse.integrate(camera, planes, {}, pose);
      last_in_coarse = pose;
    }
    fine.integrate(camera, planes, {}, pose);
    const bool isNew = std::all_of(keyframes.begin(), keyframes.end(), [&](const auto& known) {
      return farApart(known, pose, kKeyframeDistance_mm, kKeyframeAngle_rad);
    });
    if (isNew && keyframes.size() < kMaxKeyframes) {
      keyframes.push_back(pose);
    }
  }

  FramePose follow(const PreparedFrame& frame, FramePose pose) {
    const AlignmentResult result = track(frame);
    pose.rmse_mm = result.rmse_mm;
    pose.inlier_fraction = result.inlier_fraction;
    if (result.cost_mm2 < 0.0) {
      lost = true;
      previous_pose.reset();
      return pose;
    }
    relocalisations += lost ? 1 : 0;
    previous_pose = lost ? std::nullopt : last_pose;
    lost = false;
    last_pose = result.scan_from_camera;
    pose.scan_from_camera = result.scan_from_camera;
    fuse(frame.planes, result.scan_from_camera);
    return pose;
  }
};

ScanTracker::ScanTracker(const RgbdCamera& camera, const TrackingOptions& options)
    : state_(std::make_unique<State>(camera, options)) {}
ScanTracker::ScanTracker(ScanTracker&&) noexcept = default;
ScanTracker& ScanTracker::operator=(ScanTracker&&) noexcept = default;
ScanTracker::~ScanTracker() = default;

PreparedFrame::PreparedFrame(const RgbdCamera& camera,
                             const TrackingOptions& options,
                             const RgbdFrame& frame)
    : index(frame.index),
      timestamp(frame.timestamp),
      planes(fitDepthPlanes(camera.depth,
                            frame.depth,
                            {.min_depth_mm = options.min_depth_mm,
                             .max_depth_mm = options.max_depth_mm,
                             .max_depth_ratio = options.max_depth_ratio})),
      few(alignmentPoints(planes, 8)),
      some(alignmentPoints(planes, 4)),
      many(alignmentPoints(planes, 3)) {}

FramePose ScanTracker::push(const RgbdFrame& frame) {
  return push(PreparedFrame(state_->camera, state_->options, frame));
}

FramePose ScanTracker::push(const PreparedFrame& frame) {
  FramePose pose{.frame_index = frame.index, .timestamp = frame.timestamp, .scan_from_camera = {}};
  const double share =
      frame.planes.valid_count / std::max(1.0, static_cast<double>(frame.planes.quality.size()));
  if (share < kLeastValidShare) {
    state_->lost = state_->last_pose.has_value();
    state_->previous_pose.reset();
    return pose;
  }
  return state_->last_pose ? state_->follow(frame, pose) : place(frame, RigidTransform::Identity());
}

FramePose ScanTracker::place(const PreparedFrame& frame, const RigidTransform& scan_from_camera) {
  state_->last_pose = scan_from_camera;
  state_->fuse(frame.planes, scan_from_camera);
  return {.frame_index = frame.index,
          .timestamp = frame.timestamp,
          .scan_from_camera = scan_from_camera,
          .inlier_fraction = 1.0};
}

const TsdfVolume& ScanTracker::model() const { return state_->fine; }

TsdfVolume ScanTracker::takeModel() { return std::move(state_->fine); }

int ScanTracker::relocalisations() const { return state_->relocalisations; }

}  // namespace tarsus
