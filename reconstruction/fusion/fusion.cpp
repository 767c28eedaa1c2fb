#include "reconstruction/fusion/fusion.h"

#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/scan_tracker.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tarsus {
namespace {

/// Times in text files are rounded; neighbouring frames are at least ten times as far apart.
constexpr std::chrono::microseconds kSameTime{2000};

/// Share of the scan done, where its length is known.
double progress(const FrameSource& frames, int done) {
  const int expected = frames.frameCount().value_or(0);
  return expected > 0 ? std::min(1.0, static_cast<double>(done) / expected) : 0.0;
}

/// Calls use(frame) for each frame of the scan.
/// @return how many there were
template <typename Use>
Expected<int> forEachFrame(FrameSource& frames,
                           std::string_view stage,
                           const Job& job,
                           const Use& use) {
  for (int count = 0;; ++count) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    Expected<std::optional<RgbdFrame>> frame = frames.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!*frame) {
      job.report(stage, 1.0);
      return count;
    }
    use(**frame);
    job.report(stage, progress(frames, count + 1));
  }
}

void summarize(TrackingResult& result) {
  double squares = 0.0;
  for (const FramePose& pose : result.trajectory) {
    if (pose.scan_from_camera) {
      ++result.frames_tracked;
      squares += pose.rmse_mm * pose.rmse_mm;
    } else {
      ++result.frames_lost;
    }
  }
  // The first tracked frame defines the frame of reference and has no residual.
  result.rmse_mm = result.frames_tracked > 1 ? std::sqrt(squares / (result.frames_tracked - 1)) : 0;
}

}  // namespace

Expected<TrackingResult> trackScan(FrameSource& frames,
                                   const TrackingOptions& options,
                                   const Job& job) {
  ScanTracker tracker(frames.camera(), options);
  TrackingResult result;
  const auto count = forEachFrame(frames, "tracking", job, [&](const RgbdFrame& frame) {
    result.trajectory.push_back(tracker.push(frame));
  });
  if (!count) {
    return tl::unexpected(count.error());
  }
  if (*count == 0) {
    return fail(ErrorCode::ScanEmpty);
  }
  summarize(result);
  result.relocalisations = tracker.relocalisations();
  if (2 * result.frames_tracked < *count) {
    return fail(ErrorCode::TrackingLost,
                std::to_string(result.frames_tracked) + " of " + std::to_string(*count) +
                    " frames could be followed");
  }
  return result;
}

Expected<TsdfVolume> fuseScan(FrameSource& frames,
                              const Trajectory& trajectory,
                              const TsdfOptions& options,
                              const Job& job) {
  TsdfVolume volume(options);
  int fused = 0;
  const auto count = forEachFrame(frames, "fusion", job, [&](const RgbdFrame& frame) {
    const auto pose = poseAt(trajectory, frame.timestamp, kSameTime);
    if (pose) {
      volume.integrate(frames.camera(), frame, *pose);
      ++fused;
    }
  });
  if (!count) {
    return tl::unexpected(count.error());
  }
  if (fused == 0) {
    return fail(ErrorCode::ScanEmpty, "no frame has a pose");
  }
  return volume;
}

}  // namespace tarsus
