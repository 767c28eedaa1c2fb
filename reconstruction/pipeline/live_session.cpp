#include "reconstruction/pipeline/live_session.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace tarsus {

struct LiveSession::State {
  State(const RgbdCamera& scan_camera,
        const TrackingOptions& tracking_options,
        const LiveOptions& live_options)
      : camera(scan_camera),
        tracking(tracking_options),
        options(live_options),
        tracker(scan_camera, tracking_options),
        mesh(live_options.preview_min_weight) {}

  RgbdCamera camera;
  TrackingOptions tracking;
  LiveOptions options;
  ScanTracker tracker;
  PreviewMesh mesh;
  int frames = 0;          ///< pushed
  int frame_of_round = 0;  ///< pushed when the last round began
  std::chrono::microseconds time_of_round{};
  mutable std::mutex mutex;  ///< guards `published` alone
  std::shared_ptr<const LivePreview> published = std::make_shared<const LivePreview>();

  /// By the scan's clock or by the number of frames, whichever comes first: times may jitter by
  /// microseconds, or be missing altogether.
  [[nodiscard]] bool roundIsDue(std::chrono::microseconds now) const {
    const std::chrono::duration<double> since = now - time_of_round;
    return since.count() * options.preview_hz >= 1.0 ||
           (frames - frame_of_round) * options.preview_hz >= camera.frames_per_s;
  }

  void publish() {
    auto next =
        std::make_shared<const LivePreview>(LivePreview{.frames = frames, .pieces = mesh.pieces()});
    const std::scoped_lock lock(mutex);
    published.swap(next);
    // What was published before is freed after the lock, by whoever holds it last.
  }

  /// Begins a round when it is due, or goes on with one.
  int refreshPreview(std::chrono::microseconds now) {
    if (options.preview_hz <= 0.0) {
      return 0;
    }
    if (mesh.pending() == 0) {
      if (!roundIsDue(now)) {
        return 0;
      }
      frame_of_round = frames;
      time_of_round = now;
    }
    const int meshed = mesh.update(tracker.model(), std::max(1, options.preview_blocks_per_frame));
    if (meshed > 0) {
      publish();
    }
    return meshed;
  }
};

LiveSession::LiveSession(const RgbdCamera& camera,
                         const TrackingOptions& tracking,
                         const LiveOptions& options)
    : state_(std::make_unique<State>(camera, tracking, options)) {}
LiveSession::~LiveSession() = default;

PreparedFrame LiveSession::prepare(const RgbdFrame& frame) const {
  return {state_->camera, state_->tracking, frame};
}

LiveFrame LiveSession::push(const RgbdFrame& frame) { return push(prepare(frame)); }

LiveFrame LiveSession::push(const PreparedFrame& frame) {
  State& state = *state_;
  const int fused_before = state.tracker.model().framesFused();
  LiveFrame result{.pose = state.tracker.push(frame)};
  ++state.frames;
  result.lost = !result.pose.scan_from_camera.has_value();
  result.changed_blocks =
      static_cast<int>(state.tracker.model().blocksChangedSince(fused_before).size());
  result.meshed_blocks = state.refreshPreview(frame.timestamp);
  return result;
}

void LiveSession::finishPreview() {
  bool changed = false;
  while (state_->mesh.update(state_->tracker.model()) > 0) {
    changed = true;
  }
  if (changed) {
    state_->publish();
  }
}

std::shared_ptr<const LivePreview> LiveSession::preview() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->published;
}

const ScanTracker& LiveSession::tracker() const { return state_->tracker; }

}  // namespace tarsus
