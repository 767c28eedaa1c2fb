#include "reconstruction/pipeline/known_poses.h"

#include "reconstruction/capture/trajectory_file.h"

#include <algorithm>

namespace tarsus {

Expected<Trajectory> matchKnownPoses(FrameSource& frames, const Trajectory& known, const Job& job) {
  const std::chrono::microseconds tolerance(
      static_cast<long>(0.5e6 / frames.camera().frames_per_s));
  const double count = std::max(1, frames.frameCount().value_or(1));
  Trajectory matched;
  while (true) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    auto frame = frames.next();
    if (!frame) {
      return tl::unexpected(frame.error());
    }
    if (!*frame) {
      break;
    }
    matched.push_back({.frame_index = (*frame)->index,
                       .timestamp = (*frame)->timestamp,
                       .scan_from_camera = poseAt(known, (*frame)->timestamp, tolerance),
                       .inlier_fraction = 1.0});
    job.report("match poses", static_cast<double>(matched.size()) / count);
  }
  if (matched.empty()) {
    return fail(ErrorCode::ScanEmpty);
  }
  const auto has_pose = [](const FramePose& pose) { return pose.scan_from_camera.has_value(); };
  if (std::ranges::none_of(matched, has_pose)) {
    return fail(ErrorCode::TrajectoryInvalid, "no frame of the scan has a pose at its time");
  }
  return matched;
}

}  // namespace tarsus
