#include "reconstruction/fusion/fusion.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/scan_tracker.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <string>

namespace tarsus {
namespace {

/// Frames whose planes are fitted side by side before they are fused one after the other.
constexpr std::size_t kFramesAtOnce = 8;
/// How far from the first stage's surface the second stage may find its own, beyond its band: the
/// steep walls of a crater are missing in the first.
constexpr double kSurfaceMayMove_mm = 3.0;

/// Reads, packs and prepares the next frame while the caller works on this one.
class PreparedFrames {
 public:
  PreparedFrames(FrameSource& frames, const TrackingOptions& options, ScanArchive& archive)
      : frames_(frames), options_(options), archive_(archive) {
    start();
  }

  Expected<std::optional<PreparedFrame>> next() {
    Expected<std::optional<PreparedFrame>> frame = loading_.get();
    if (frame && *frame) {
      start();
    }
    return frame;
  }

 private:
  void start() {
    loading_ = std::async(std::launch::async, [this] { return load(); });
  }
  Expected<std::optional<PreparedFrame>> load() {
    Expected<std::optional<RgbdFrame>> frame = frames_.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!*frame) {
      return std::nullopt;
    }
    archive_.add(**frame);
    return PreparedFrame(frames_.camera(), options_, **frame);
  }

  FrameSource& frames_;
  const TrackingOptions& options_;
  ScanArchive& archive_;
  std::future<Expected<std::optional<PreparedFrame>>> loading_;
};

void summarize(TrackedScan& scan) {
  double squares = 0.0;
  for (const FramePose& pose : scan.trajectory) {
    scan.frames_tracked += pose.scan_from_camera ? 1 : 0;
    squares += pose.scan_from_camera ? pose.rmse_mm * pose.rmse_mm : 0.0;
  }
  // The first tracked frame defines the frame of reference and has no residual.
  scan.rmse_mm = scan.frames_tracked > 1 ? std::sqrt(squares / (scan.frames_tracked - 1)) : 0.0;
}

/// Goes once through the scan; `follow` gives each frame its pose.
template <typename Follow>
Expected<TrackedScan> firstPass(FrameSource& frames,
                                const TrackingOptions& options,
                                const Job& job,
                                const Follow& follow) {
  ScanTracker tracker(frames.camera(), options);
  const int expected = frames.frameCount().value_or(0);
  ScanArchive archive(frames.camera(), expected);
  Trajectory trajectory;
  std::vector<FramePoints> points;
  PreparedFrames prepared(frames, options, archive);
  while (true) {
    auto frame = prepared.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!*frame) {
      break;
    }
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    trajectory.push_back(follow(tracker, **frame));
    points.push_back((*frame)->some);  // a copy takes no more room than it needs
    const double done = static_cast<double>(trajectory.size());
    job.report("tracking", expected > 0 ? std::min(1.0, done / expected) : 0.0);
  }
  if (trajectory.empty()) {
    return fail(ErrorCode::ScanEmpty);
  }
  TrackedScan scan{.trajectory = std::move(trajectory),
                   .relocalisations = tracker.relocalisations(),
                   .model = tracker.takeModel(),
                   .points = std::move(points),
                   .archive = std::move(archive)};
  summarize(scan);
  return scan;
}

}  // namespace

Expected<TrackedScan> trackScan(FrameSource& frames,
                                const TrackingOptions& options,
                                const Job& job) {
  auto scan = firstPass(frames, options, job, [](ScanTracker& tracker, const PreparedFrame& frame) {
    return tracker.push(frame);
  });
  if (scan && 2 * scan->frames_tracked < static_cast<int>(scan->trajectory.size())) {
    return fail(ErrorCode::TrackingLost,
                std::to_string(scan->frames_tracked) + " of " +
                    std::to_string(scan->trajectory.size()) + " frames could be followed");
  }
  return scan;
}

Expected<TrackedScan> placeScan(FrameSource& frames,
                                const Trajectory& known,
                                const TrackingOptions& options,
                                const Job& job) {
  const std::chrono::microseconds tolerance(
      static_cast<long>(0.5e6 / frames.camera().frames_per_s));
  const auto follow = [&](ScanTracker& tracker, const PreparedFrame& frame) {
    const auto pose = poseAt(known, frame.timestamp, tolerance);
    return pose ? tracker.place(frame, *pose)
                : FramePose{.frame_index = frame.index, .timestamp = frame.timestamp};
  };
  auto scan = firstPass(frames, options, job, follow);
  if (scan && scan->frames_tracked == 0) {
    return fail(ErrorCode::TrajectoryInvalid, "no frame of the scan has a pose at its time");
  }
  return scan;
}

Expected<TsdfVolume> fuseScan(const ScanArchive& frames,
                              const Trajectory& trajectory,
                              std::span<const Eigen::Vector3f> near,
                              const TsdfOptions& options,
                              const Job& job) {
  TARSUS_REQUIRE(static_cast<std::size_t>(frames.frameCount()) == trajectory.size(),
                 "one pose for each frame");
  std::vector<int> tracked;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (trajectory[i].scan_from_camera) {
      tracked.push_back(static_cast<int>(i));
    }
  }
  if (tracked.empty()) {
    return fail(ErrorCode::ScanEmpty, "no frame has a pose");
  }
  TsdfVolume volume(options);
  if (!near.empty()) {
    volume.confineTo(near, options.weighting.delta_mm + kSurfaceMayMove_mm);
  }
  const DepthPlaneOptions plane_options{.min_depth_mm = options.min_depth_mm,
                                        .max_depth_mm = options.max_depth_mm,
                                        .max_depth_ratio = options.max_depth_ratio};
  for (std::size_t first = 0; first < tracked.size(); first += kFramesAtOnce) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    std::vector<DepthPlanes> planes(std::min(kFramesAtOnce, tracked.size() - first));
    parallelFor(static_cast<int>(planes.size()), [&](int k) {
      const RgbdFrame frame = frames.frame(tracked[first + static_cast<std::size_t>(k)]);
      planes[static_cast<std::size_t>(k)] =
          fitDepthPlanes(frames.camera().depth, frame.depth, plane_options);
    });
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const auto i = static_cast<std::size_t>(tracked[first + k]);
      const ColorImage none;
      volume.integrate(frames.camera(),
                       planes[k],
                       options.with_color ? frames.color(tracked[first + k]) : none,
                       *trajectory[i].scan_from_camera);
    }
    job.report("fusion",
               static_cast<double>(first + planes.size()) / static_cast<double>(tracked.size()));
  }
  return volume;
}

}  // namespace tarsus
