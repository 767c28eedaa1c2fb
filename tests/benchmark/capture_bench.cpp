/// The capture path against the simulated camera. Run:
///   tarsus-bench-capture cycles SCAN [100]   open, record 10 frames, close, so many times
///   tarsus-bench-capture live SCAN OUT       record and track SCAN once at its own rate

#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/openni/simulated_camera/frame_player.h"
#include "reconstruction/pipeline/live_scan.h"

#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

namespace {

using namespace tarsus;

double processorSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Of this process's threads with that name; they must still live.
double processorSecondsOf(const std::string& thread_name) {
  double seconds = 0.0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    if (name != thread_name) {
      continue;
    }
    std::string stat;
    std::getline(std::ifstream(task.path() / "stat"), stat);
    std::istringstream fields(stat.substr(stat.rfind(')') + 1));  // proc(5): utime is the 14th
    std::string skipped;
    for (int i = 0; i < 11; ++i) {
      fields >> skipped;
    }
    double user = 0.0;
    double system = 0.0;
    fields >> user >> system;
    seconds += (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  return seconds;
}

int stopped(const Error& error) {
  std::fprintf(stderr, "%s\n", describe(error).c_str());
  return 1;
}

int cycles(const std::string& scan, int count) {
  constexpr int kFrames = 10;
  const std::filesystem::path out = std::filesystem::temp_directory_path() / "tarsus-bench-capture";
  int whole = 0;
  int dropped = 0;
  for (int i = 0; i < count; ++i) {
    const auto camera = OpenNiCamera::open(simulatedUri(scan));
    if (!camera) {
      return stopped(camera.error());
    }
    auto recorder = ScanRecorder::create(out, (*camera)->camera(), 1.0);
    if (!recorder) {
      return stopped(recorder.error());
    }
    std::atomic<int> taken = 0;
    const auto started = (*camera)->start([&](RgbdFrame frame) {
      if (taken < kFrames &&
          (*recorder)->add(std::make_shared<const RgbdFrame>(std::move(frame)))) {
        ++taken;
      }
    });
    if (!started) {
      return stopped(started.error());
    }
    while (taken < kFrames) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    (*camera)->stop();
    if (auto finished = (*recorder)->finish(); !finished) {
      return stopped(finished.error());
    }
    whole += (*recorder)->counts().written == kFrames ? 1 : 0;
    dropped += (*camera)->counts().dropped;
  }
  std::filesystem::remove_all(out);
  std::printf(
      "%d cycles of open, record, close: %d whole, %d frames dropped\n", count, whole, dropped);
  return whole == count && dropped == 0 ? 0 : 1;
}

int live(const std::string& scan, const std::string& out) {
  LiveScanOptions options;
  const auto session = LiveScan::open(simulatedUri(scan), options);
  if (!session) {
    return stopped(session.error());
  }
  const double camera_hz = (*session)->camera().camera().frames_per_s;
  const double processor_before = processorSeconds();
  const auto begin = std::chrono::steady_clock::now();
  if (auto begun = (*session)->begin(out); !begun) {
    return stopped(begun.error());
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(options.guide.scan_s));
  const double camera_s = processorSecondsOf(FramePlayer::kThreadName);
  if (auto ended = (*session)->end(); !ended) {
    return stopped(ended.error());
  }
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const LiveView view = (*session)->view();
  std::printf("camera %.0f Hz, %.1f s: %d frames recorded (%.1f a second), %.0f MB\n",
              camera_hz,
              wall_s,
              view.recorded.written,
              view.recorded.written / wall_s,
              view.recorded.megabytes);
  std::printf("dropped by the camera %d, by the recorder %d; passed over by tracking %d, lost %d\n",
              view.captured.dropped,
              view.recorded.dropped,
              view.not_tracked,
              view.guidance.frames_lost);
  std::printf("%.2f cores in the simulated camera itself\n", camera_s / wall_s);
  std::printf("coverage %.0f %%; %.2f cores in all (camera, recording, tracking, preview)\n",
              view.coverage ? view.coverage->percent : 0.0,
              (processorSeconds() - processor_before) / wall_s);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 2 ? argv[1] : "";
  if (what == "cycles") {
    return cycles(argv[2], argc > 3 ? std::atoi(argv[3]) : 100);
  }
  if (what == "live" && argc > 3) {
    return live(argv[2], argv[3]);
  }
  std::fprintf(stderr, "usage: tarsus-bench-capture cycles SCAN [COUNT] | live SCAN OUT\n");
  return 2;
}
