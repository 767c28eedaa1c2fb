#include "reconstruction/pipeline/live_scan.h"

#include "reconstruction/capture/frame_preparation.h"
#include "reconstruction/pipeline/foot_preview.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

namespace tarsus {
namespace {

/// Frames that wait for tracking; a tenth of a second.
constexpr std::size_t kMostWaiting = 3;

}  // namespace

/// One scan from begin to end.
struct Tracked {
  Tracked(const KnownCamera& known, const LiveScanOptions& options)
      : preparation(known.camera, known.facts.depth_correction.value_or(DepthCorrection{})),
        session(preparation.camera(), options.tracking, options.live),
        guide(options.guide) {}

  FramePreparation preparation;
  LiveSession session;
  ScanGuide guide;
  Trajectory trajectory;
};

struct LiveScan::State {
  LiveScanOptions options;
  std::unique_ptr<OpenNiCamera> camera;
  KnownCamera known;

  mutable std::mutex mutex;  ///< guards all to the next empty line
  std::condition_variable_any changed;
  LiveView view;
  std::unique_ptr<ScanRecorder> recorder;
  std::deque<std::shared_ptr<const RgbdFrame>> waiting;
  Trajectory survey_trajectory;  ///< copy for the surveying thread
  bool survey_due = false;

  ScanGuide idle_guide;  ///< of the camera's thread, before a scan
  std::jthread tracking;
  std::jthread surveying;

  void take(RgbdFrame frame);
  void track(const std::stop_token& stop, Tracked& tracked);
  void look(Tracked& tracked,
            const std::shared_ptr<const RgbdFrame>& newest,
            double coverage_percent);
  void survey(const std::stop_token& stop);
  Expected<void> end();
};

/// On the camera's thread: hands on, and never waits.
void LiveScan::State::take(RgbdFrame frame) {
  const auto shared = std::make_shared<const RgbdFrame>(std::move(frame));
  const std::scoped_lock lock(mutex);
  view.frame = shared;
  if (!recorder) {
    view.guidance = idle_guide.update(
        *shared,
        {.pose = {.timestamp = shared->timestamp, .scan_from_camera = RigidTransform::Identity()}},
        0.0);
    return;
  }
  recorder->add(shared);
  waiting.push_back(shared);
  if (waiting.size() > kMostWaiting) {
    waiting.pop_front();
    ++view.not_tracked;
  }
  changed.notify_all();
}

void LiveScan::State::track(const std::stop_token& stop, Tracked& tracked) {
  while (true) {
    std::shared_ptr<const RgbdFrame> frame;
    double coverage_percent = 0.0;
    {
      std::unique_lock lock(mutex);
      if (!changed.wait(lock, stop, [&] { return !waiting.empty(); })) {
        return;
      }
      frame = std::move(waiting.front());
      waiting.pop_front();
      coverage_percent = view.coverage ? view.coverage->percent : 0.0;
    }
    look(tracked, frame, coverage_percent);
  }
}

void LiveScan::State::look(Tracked& tracked,
                           const std::shared_ptr<const RgbdFrame>& newest,
                           double coverage_percent) {
  const RgbdFrame& sensor = *newest;
  const RgbdFrame frame{.index = sensor.index,
                        .timestamp = sensor.timestamp,
                        .depth = tracked.preparation.depth(sensor.depth),
                        .color = {}};
  const LiveFrame live = tracked.session.push(frame);
  const ScanGuidance guidance = tracked.guide.update(sensor, live, coverage_percent);
  tracked.trajectory.push_back(live.pose);
  const std::scoped_lock lock(mutex);
  view.guidance = guidance;
  view.preview = tracked.session.preview();
  if (live.pose.scan_from_camera) {
    view.tracked = newest;
    view.scan_from_camera = live.pose.scan_from_camera;
  }
  const auto every = static_cast<std::size_t>(
      std::max(1.0, options.coverage_every_s * camera->camera().frames_per_s));
  if (!survey_due && tracked.trajectory.size() % every == 0) {
    survey_trajectory = tracked.trajectory;
    survey_due = true;
    changed.notify_all();
  }
}

/// The foot and how much of it was seen: slow, so now and then, beside the tracking.
void LiveScan::State::survey(const std::stop_token& stop) {
  while (true) {
    std::shared_ptr<const LivePreview> preview;
    Trajectory trajectory;
    {
      std::unique_lock lock(mutex);
      if (!changed.wait(lock, stop, [&] { return survey_due; })) {
        return;
      }
      preview = view.preview;
      trajectory = std::exchange(survey_trajectory, {});
    }
    std::shared_ptr<const Coverage> coverage;
    std::shared_ptr<const PreviewSurface> foot;
    if (preview) {
      foot = std::make_shared<const PreviewSurface>(footOf(preview->pieces, trajectory));
      coverage = std::make_shared<const Coverage>(coverageOf(*foot, options.coverage));
    }
    const std::scoped_lock lock(mutex);
    view.foot = std::move(foot);
    view.coverage = std::move(coverage);
    survey_due = false;
  }
}

Expected<void> LiveScan::State::end() {
  std::unique_ptr<ScanRecorder> ended;
  {
    const std::scoped_lock lock(mutex);
    ended = std::move(recorder);
  }
  tracking = {};
  surveying = {};
  const Expected<void> finished = ended ? ended->finish() : Expected<void>();
  const std::scoped_lock lock(mutex);
  waiting.clear();
  survey_due = false;
  if (ended) {
    view.recorded = ended->counts();
    view.failure = ended->failure();
  }
  return finished;
}

Expected<KnownCamera> knownCamera(const OpenNiCamera& camera,
                                  const std::filesystem::path& calibration,
                                  std::string_view today) {
  auto known = knownCamera(camera.camera(), calibration, today);
  if (!known) {
    return known;
  }
  if (camera.describesItself()) {
    std::erase_if(known->warnings,
                  [](const Warning& w) { return w.code == "calibration_missing"; });
  }
  if (!known->facts.depth_correction) {  // it tells the unit too
    const Warnings& doubts = camera.warnings();
    known->warnings.insert(known->warnings.end(), doubts.begin(), doubts.end());
  }
  return known;
}

Expected<std::unique_ptr<LiveScan>> LiveScan::open(const std::string& uri,
                                                   const LiveScanOptions& options) {
  auto camera = OpenNiCamera::open(uri);
  if (!camera) {
    return tl::unexpected(camera.error());
  }
  auto state = std::make_unique<State>();
  state->options = options;
  state->idle_guide = ScanGuide(options.guide);
  state->camera = std::move(*camera);
  auto known = knownCamera(*state->camera, options.calibration, options.today);
  if (!known) {
    return tl::unexpected(known.error());
  }
  state->known = std::move(*known);
  const auto started =
      state->camera->start([s = state.get()](RgbdFrame frame) { s->take(std::move(frame)); });
  if (!started) {
    return tl::unexpected(started.error());
  }
  return std::unique_ptr<LiveScan>(new LiveScan(std::move(state)));
}

LiveScan::LiveScan(std::unique_ptr<State> state) : state_(std::move(state)) {}

LiveScan::~LiveScan() {
  state_->camera->stop();  // first: its thread uses all else
  static_cast<void>(state_->end());
}

const OpenNiCamera& LiveScan::camera() const { return *state_->camera; }
const KnownCamera& LiveScan::known() const { return state_->known; }

Expected<void> LiveScan::begin(const std::filesystem::path& folder) {
  if (auto ended = end(); !ended) {
    return ended;
  }
  const KnownCamera& known = state_->known;
  auto recorder = ScanRecorder::create(
      folder, known.camera, state_->options.guide.scan_s, {.facts = known.facts});
  if (!recorder) {
    return tl::unexpected(recorder.error());
  }
  auto tracked = std::make_shared<Tracked>(known, state_->options);
  {
    const std::scoped_lock lock(state_->mutex);
    state_->view.recorded = {};
    state_->view.not_tracked = 0;
    state_->view.failure.reset();
    state_->view.preview = tracked->session.preview();
    state_->view.coverage.reset();
    state_->view.foot.reset();
    state_->view.tracked.reset();
    state_->view.scan_from_camera.reset();
    state_->recorder = std::move(*recorder);
  }
  state_->tracking = std::jthread(
      [s = state_.get(), tracked](const std::stop_token& stop) { s->track(stop, *tracked); });
  state_->surveying =
      std::jthread([s = state_.get()](const std::stop_token& stop) { s->survey(stop); });
  return {};
}

Expected<void> LiveScan::end() { return state_->end(); }

LiveView LiveScan::view() const {
  const std::scoped_lock lock(state_->mutex);
  LiveView view = state_->view;
  view.camera = state_->camera->state();
  view.captured = state_->camera->counts();
  if (state_->recorder) {
    view.recorded = state_->recorder->counts();
    view.failure = state_->recorder->failure();
  }
  return view;
}

}  // namespace tarsus
