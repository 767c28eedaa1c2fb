#include "ui/work/scan_camera.h"

#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/pipeline/live_scan.h"
#include "ui/work/growing_foot.h"
#include "ui/work/images.h"

#include <QDate>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr auto kTick = std::chrono::milliseconds(66);
constexpr auto kLookAgain = std::chrono::seconds(2);
constexpr QSize kFootPicture(760, 880);
constexpr int kSimulatedFrames = 240;

}  // namespace

struct ScanCamera::Worker {
  ScanCamera* owner;
  fs::path own;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::deque<std::function<void()>> tasks;
  std::atomic<bool> shown_pending = false;

  // Of the worker's thread alone.
  bool wanted = false;
  std::string uri;
  bool simulated = false;
  bool recording = false;
  std::unique_ptr<LiveScan> live;
  std::unique_ptr<GrowingFoot> growing;
  std::shared_ptr<const PreviewSurface> drawn;
  Clock::time_point look_at{};
  ScanMoment moment;
  std::stop_token stop;

  std::jthread thread;  // last: ends before the rest is gone

  Worker(ScanCamera* of, fs::path folder) : owner(of), own(std::move(folder)) {
    thread = std::jthread([this](const std::stop_token& token) {
      stop = token;
      run();
    });
  }

  void post(std::function<void()> task) {
    const std::scoped_lock lock(mutex);
    tasks.push_back(std::move(task));
    wake.notify_all();
  }
  template <typename Act>
  void tell(Act act) {
    QMetaObject::invokeMethod(owner, std::move(act), Qt::QueuedConnection);
  }
  void run();
  void tick();
  void open();
  void show(const LiveView& view);
  void send();
  void begin(const fs::path& folder);
  void end();
  void close();
  void prepareSimulated();
};

void ScanCamera::Worker::run() {
  while (!stop.stop_requested()) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex);
      wake.wait_for(lock, stop, kTick, [this] { return !tasks.empty(); });
      if (!tasks.empty()) {
        task = std::move(tasks.front());
        tasks.pop_front();
      }
    }
    if (task) {
      task();
    } else if (wanted && !stop.stop_requested()) {
      tick();
    }
  }
  live.reset();
}

void ScanCamera::Worker::tick() {
  if (!live && Clock::now() >= look_at) {
    open();
  }
  if (live && !shown_pending) {
    show(live->view());
    send();
  }
}

void ScanCamera::Worker::send() {
  shown_pending = true;
  tell([this, now = moment] {
    shown_pending = false;
    emit owner->shown(now);
  });
  moment.foot = {};
}

void ScanCamera::Worker::open() {
  std::string found = uri;
  moment.problem = {};
  if (found.empty()) {
    const auto cameras = listCameras();
    if (!cameras || cameras->empty()) {
      moment.camera = ScanMoment::Camera::None;
      look_at = Clock::now() + kLookAgain;
      send();
      return;
    }
    found = cameras->front().uri;
  }
  LiveScanOptions options;
  options.today = QDate::currentDate().toString(Qt::ISODate).toStdString();
  options.coverage_every_s = 1.0;
  // Beside the records, where `calibrate` puts them; own is the work folder within the records.
  options.calibration = own.parent_path().parent_path() / "calibration";
  auto opened = LiveScan::open(found, options);
  if (!opened) {
    moment.camera = ScanMoment::Camera::Failed;
    moment.problem = opened.error();
    look_at = Clock::now() + kLookAgain;
    send();
    return;
  }
  live = std::move(*opened);
  const RgbdCamera& camera = live->known().camera;
  moment.name = QString::fromStdString(camera.model);
  moment.simulated = found.starts_with("tarsus:");
  growing = std::make_unique<GrowingFoot>(camera);
}

void ScanCamera::Worker::show(const LiveView& view) {
  const bool gone = view.camera == CameraState::Unplugged;
  moment.camera = gone ? ScanMoment::Camera::Gone : ScanMoment::Camera::Live;
  moment.recording = recording;
  moment.guidance = view.guidance;
  moment.frames = view.recorded.written;
  moment.stopped = recording && view.failure.has_value();
  moment.problem = view.failure.value_or(Error{});
  moment.color = {};
  moment.depth = {};
  if (view.frame && !gone) {
    moment.color = imageOf(view.frame->color);
    moment.depth = depthPicture(view.frame->depth, kNear_mm, kFar_mm);
  }
  if (recording && view.tracked && view.scan_from_camera) {
    moment.tracked = true;
    growing->see(view.tracked, *view.scan_from_camera);
    moment.aim = drawn ? growing->lookedAt(*view.scan_from_camera) : QRectF();
  }
  if (view.foot && view.foot != drawn && recording) {
    drawn = view.foot;
    moment.foot = growing->picture(*drawn, CoverageOptions{}.well_seen_weight, kFootPicture);
  }
}

void ScanCamera::Worker::begin(const fs::path& folder) {
  if (!live) {
    tell([this] { emit owner->ended(0, {ErrorCode::CameraNotFound, {}}); });
    return;
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  drawn.reset();
  moment.aim = {};
  moment.tracked = false;
  growing = std::make_unique<GrowingFoot>(live->known().camera);
  if (const auto begun = live->begin(folder); !begun) {
    tell([this, why = begun.error()] { emit owner->ended(0, why); });
    return;
  }
  recording = true;
  tell([this] { emit owner->begun(); });
}

void ScanCamera::Worker::end() {
  if (!recording) {
    return;
  }
  recording = false;
  const auto finished = live->end();
  const int frames = live->view().recorded.written;
  const Error problem = finished ? Error{} : finished.error();
  const bool kept = frames > 0;
  tell([this, frames, problem = kept || finished ? problem : finished.error()] {
    emit owner->ended(frames, problem);
  });
}

void ScanCamera::Worker::close() {
  end();
  live.reset();
  wanted = false;
  look_at = {};
  moment = {};
}

void ScanCamera::Worker::prepareSimulated() {
  std::error_code ignored;
  const fs::path scan = own / "simulated-foot";
  if (!fs::exists(scan / "depth.txt", ignored)) {
    const fs::path part = own / "simulated-foot.part";
    fs::remove_all(part, ignored);
    fs::create_directories(own, ignored);
    moment.camera = ScanMoment::Camera::Preparing;
    send();
    SimulatorOptions options;
    options.frames = kSimulatedFrames;
    const Job job{.stop = stop, .report = [this](std::string_view, double fraction) {
                    moment.prepared = fraction;
                    if (!shown_pending) {
                      send();
                    }
                  }};
    if (const auto made = simulateScan(part, options, job); !made) {
      moment.camera = ScanMoment::Camera::Failed;
      moment.problem = made.error();
      send();
      return;
    }
    fs::rename(part, scan, ignored);
  }
  uri = simulatedUri(scan.string());
  look_at = {};
}

ScanCamera::ScanCamera(fs::path own, QObject* parent)
    : QObject(parent), worker_(std::make_unique<Worker>(this, std::move(own))) {}

ScanCamera::~ScanCamera() = default;

void ScanCamera::start() {
  worker_->post([w = worker_.get()] { w->wanted = true; });
}

void ScanCamera::stop() {
  worker_->post([w = worker_.get()] { w->close(); });
}

void ScanCamera::simulate() {
  worker_->post([w = worker_.get()] { w->prepareSimulated(); });
}

void ScanCamera::setUri(const std::string& uri) {
  worker_->post([w = worker_.get(), uri] {
    w->end();
    w->live.reset();
    w->uri = uri;
    w->look_at = {};
    w->moment = {};
    w->send();
  });
}

void ScanCamera::begin(const fs::path& folder) {
  worker_->post([w = worker_.get(), folder] { w->begin(folder); });
}

void ScanCamera::end() {
  worker_->post([w = worker_.get()] { w->end(); });
}

}  // namespace tarsus
