#include "reconstruction/capture/scan_recorder.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/frame_list.h"
#include "reconstruction/capture/image_file.h"

#include <condition_variable>
#include <deque>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerMb = 1e6;
/// Depth packs to a third, colour to two thirds, on simulated and real scans.
constexpr double kPacked = 0.6;
constexpr int kWriters = 2;

double megabytesPerFrame(const RgbdCamera& camera) {
  const auto pixels = [](const Intrinsics& i) { return static_cast<double>(i.width) * i.height; };
  return kPacked * (2.0 * pixels(camera.depth) + 3.0 * pixels(camera.color)) / kBytesPerMb;
}

}  // namespace

struct ScanRecorder::State {
  /// A frame that is on the disk.
  struct Listed {
    std::string time;
    bool with_color = false;
  };

  fs::path folder;
  RgbdCamera camera;
  RecorderOptions options;

  mutable std::mutex mutex;  ///< guards all that follows but the threads
  std::condition_variable changed;
  std::deque<std::pair<int, std::shared_ptr<const RgbdFrame>>> waiting;  ///< numbered here
  /// Ready for the lists, as soon as those before them are.
  std::map<int, Listed> done;
  int next_listed = 0;
  int accepted = 0;
  bool closing = false;
  RecorderCounts counts;
  std::optional<Error> failure;
  std::ofstream depth_list;
  std::ofstream color_list;

  std::vector<std::thread> writers;

  void close();
  void write();
  [[nodiscard]] Expected<double> writeImages(const RgbdFrame& frame) const;
  [[nodiscard]] double freeMb() const;
  void list();
};

double ScanRecorder::State::freeMb() const {
  std::error_code error;
  const auto space = fs::space(folder, error);
  return options.free_mb.value_or(error ? 1e9 : static_cast<double>(space.available) / kBytesPerMb);
}

/// @return  size [MB]
Expected<double> ScanRecorder::State::writeImages(const RgbdFrame& frame) const {
  if (freeMb() < options.least_free_mb) {
    return fail(ErrorCode::DiskFull,
                "less than " + std::to_string(static_cast<int>(options.least_free_mb)) +
                    " MB are free at " + folder.string());
  }
  const std::string name = timeText(frame.timestamp) + ".png";
  const fs::path depth = folder / "depth" / name;
  const fs::path color = folder / "rgb" / name;
  auto written = writeDepthImage(depth, frame.depth, camera.depth_units_per_m, Flush::Later);
  if (written && frame.color.width() > 0) {
    written = writeColorImage(color, frame.color, Flush::Later);
  }
  if (!written) {
    return tl::unexpected(written.error());
  }
  std::error_code ignored;
  double bytes = static_cast<double>(fs::file_size(depth, ignored));
  bytes += frame.color.width() > 0 ? static_cast<double>(fs::file_size(color, ignored)) : 0.0;
  return bytes / kBytesPerMb;
}

void ScanRecorder::State::write() {
  std::unique_lock lock(mutex);
  while (true) {
    changed.wait(lock, [&] { return closing || !waiting.empty(); });
    if (waiting.empty()) {
      return;
    }
    const auto [number, frame] = std::move(waiting.front());
    waiting.pop_front();
    const bool stopped = failure.has_value();
    lock.unlock();
    const auto size_mb = stopped ? Expected<double>(0.0) : writeImages(*frame);
    lock.lock();
    if (!size_mb && !failure) {
      failure = size_mb.error();
    }
    if (failure) {
      ++counts.dropped;
      continue;
    }
    counts.megabytes += *size_mb;
    done.emplace(number, Listed{timeText(frame->timestamp), frame->color.width() > 0});
    list();
  }
}

/// Lists the frames in their order, each as soon as all before it are written.
void ScanRecorder::State::list() {
  while (!done.empty() && done.begin()->first == next_listed) {
    const auto& [time, with_color] = done.begin()->second;
    if (with_color) {
      color_list << time << " rgb/" << time << ".png\n" << std::flush;
    }
    depth_list << time << " depth/" << time << ".png\n" << std::flush;
    if (!depth_list || !color_list) {
      failure = failure.value_or(
          Error{.code = ErrorCode::FileUnwritable, .detail = (folder / "depth.txt").string()});
    }
    ++counts.written;
    ++next_listed;
    done.erase(done.begin());
  }
}

void ScanRecorder::State::close() {
  {
    const std::scoped_lock lock(mutex);
    closing = true;
  }
  changed.notify_all();
  for (std::thread& writer : writers) {
    writer.join();
  }
  writers.clear();
}

Expected<std::unique_ptr<ScanRecorder>> ScanRecorder::create(const fs::path& folder,
                                                             const RgbdCamera& camera,
                                                             double expected_s,
                                                             const RecorderOptions& options) {
  auto state = std::make_unique<State>();
  state->folder = folder;
  state->camera = camera;
  state->options = options;
  if (auto written = writeCamera(folder / "camera.json", camera, options.facts); !written) {
    return tl::unexpected(written.error());
  }
  const double needed_mb = megabytesPerFrame(camera) * camera.frames_per_s * expected_s;
  if (state->freeMb() < needed_mb + options.least_free_mb) {
    return fail(ErrorCode::DiskFull,
                "a scan of " + std::to_string(static_cast<int>(expected_s)) + " s needs " +
                    std::to_string(static_cast<int>(needed_mb + options.least_free_mb)) +
                    " MB, and " + std::to_string(static_cast<int>(state->freeMb())) +
                    " MB are free at " + folder.string());
  }
  std::error_code ignored;
  for (const char* list : {"associations.txt", "groundtruth.txt"}) {
    fs::remove(folder / list, ignored);  // of an earlier scan here
  }
  state->depth_list.open(folder / "depth.txt", std::ios::trunc);
  state->color_list.open(folder / "rgb.txt", std::ios::trunc);
  state->depth_list << "# timestamp filename\n" << std::flush;
  state->color_list << "# timestamp filename\n" << std::flush;
  if (!state->depth_list || !state->color_list) {
    return fail(ErrorCode::FileUnwritable, (folder / "depth.txt").string());
  }
  for (int i = 0; i < kWriters; ++i) {
    state->writers.emplace_back([s = state.get()] { s->write(); });
  }
  return std::unique_ptr<ScanRecorder>(new ScanRecorder(std::move(state)));
}

ScanRecorder::ScanRecorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
ScanRecorder::~ScanRecorder() { state_->close(); }

bool ScanRecorder::add(std::shared_ptr<const RgbdFrame> frame) {
  {
    const std::scoped_lock lock(state_->mutex);
    if (state_->closing || state_->failure ||
        static_cast<int>(state_->waiting.size()) >= state_->options.most_waiting) {
      ++state_->counts.dropped;
      return false;
    }
    state_->waiting.emplace_back(state_->accepted++, std::move(frame));
  }
  state_->changed.notify_one();
  return true;
}

Expected<void> ScanRecorder::finish() {
  state_->close();
  const std::scoped_lock lock(state_->mutex);
  return state_->failure ? tl::unexpected(*state_->failure) : Expected<void>();
}

RecorderCounts ScanRecorder::counts() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->counts;
}

std::optional<Error> ScanRecorder::failure() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->failure;
}

}  // namespace tarsus
