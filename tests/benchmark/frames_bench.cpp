// Time and memory of the hot loops on frames that lie in memory, as one line of JSON each:
//   tarsus-bench-frames integrate SCAN [options]   TsdfVolume::integrate with the true poses
//   tarsus-bench-frames stream SCAN [options]      LiveSession::push: tracking and fusion; with
//     --preview-hz 5 in turn with a session that has the preview mesh; --pipelined prepares the
//     next frame meanwhile
//   tarsus-bench-frames compare MODEL.ply TRUE.ply distances of the model's vertices, see below
// open3d_side.py does the same with Open3D; the options are the same too.

#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/tsdf_volume.h"
#include "reconstruction/pipeline/live_session.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/ply.h"
#include "tests/benchmark/bench_support.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <future>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tarsus;  // NOLINT: a program of its own

struct Options {
  std::filesystem::path scan;
  double voxel_size_mm = 2.0;
  double delta_mm = 9.0;
  double far_mm = 700.0;
  int frames = 150;
  int hot_frame = -1;  ///< the one that callgrind counts; -1: none
  bool color = false;
  double preview_hz = 0.0;  ///< rounds of the preview mesh in a second of the scan
  bool pipelined = false;
  std::filesystem::path mesh;  ///< empty: no surface is written
  std::filesystem::path reference;
};

struct LoadedScan {
  RgbdCamera camera;
  std::vector<RgbdFrame> frames;
  Trajectory truth;
  Trajectory given;  ///< one true pose for each frame

  [[nodiscard]] const RigidTransform& pose(std::size_t i) const {
    return *given[i].scan_from_camera;
  }
};

LoadedScan load(const Options& options) {
  LoadedScan scan;
  scan.truth = orExit(readTrajectory(options.scan / "groundtruth.txt"));
  const auto source = orExit(openScanFolder(options.scan, {}, {.color = options.color}));
  scan.camera = source->camera();
  while (static_cast<int>(scan.frames.size()) < options.frames) {
    auto frame = orExit(source->next());
    if (!frame) {
      break;
    }
    constexpr std::chrono::microseconds kSameTime{20000};
    const auto pose = poseAt(scan.truth, frame->timestamp, kSameTime);
    if (pose) {
      scan.given.push_back(
          {.frame_index = frame->index, .timestamp = frame->timestamp, .scan_from_camera = *pose});
      scan.frames.push_back(std::move(*frame));
    }
  }
  return scan;
}

/// Times of all frames of one run.
struct Clock {
  std::vector<double> wall_ms;
  double cpu_ms = 0.0;

  void time(const std::function<void()>& work) {
    const StopWatch watch;
    work();
    wall_ms.push_back(1000.0 * watch.wall_s());
    cpu_ms += 1000.0 * watch.cpu_s();
  }
  [[nodiscard]] double median_ms() const {
    std::vector<double> sorted = wall_ms;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }
  [[nodiscard]] double frames() const { return static_cast<double>(wall_ms.size()); }
  [[nodiscard]] double mean_ms() const {
    return std::accumulate(wall_ms.begin(), wall_ms.end(), 0.0) / frames();
  }
};

TsdfOptions volumeOptions(const Options& options) {
  TsdfOptions result;
  result.voxel_size_mm = options.voxel_size_mm;
  result.weighting.delta_mm = options.delta_mm;
  result.max_depth_mm = options.far_mm;
  result.max_depth_ratio = 0.0;  // the same limit for every frame, as Open3D has it
  result.with_color = options.color;
  return result;
}

/// Voxels of the blocks that one frame touches, from volumes that hold one frame each.
double touchedVoxels(const LoadedScan& scan, const Options& options) {
  constexpr std::size_t kEvery = 5;
  constexpr double kVoxelsOfBlock = 512.0;
  double blocks = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < scan.frames.size(); i += kEvery) {
    TsdfVolume volume(volumeOptions(options));
    volume.integrate(scan.camera, scan.frames[i], scan.pose(i));
    blocks += volume.blockCount();
    ++count;
  }
  return kVoxelsOfBlock * blocks / std::max(1, count);
}

void writeSurface(const TsdfVolume& volume, const Options& options) {
  if (options.mesh.empty()) {
    return;
  }
  constexpr float kLeastWeight = 3.0F;
  TexturedMesh model;
  model.mesh = volume.extractSurface(kLeastWeight).mesh;
  orExit(writePly(options.mesh, model));
}

void print(const Clock& clock, double work_mb, int blocks, const std::string& further) {
  std::printf(
      "{\"program\": \"tarsus\", \"frames\": %zu, \"wall_ms\": %.4f, \"mean_ms\": %.4f, "
      "\"cpu_ms\": %.4f, \"work_mb\": %.1f, \"blocks\": %d, %s}\n",
      clock.wall_ms.size(),
      clock.median_ms(),
      clock.mean_ms(),
      clock.cpu_ms / clock.frames(),
      work_mb,
      blocks,
      further.c_str());
}

}  // namespace

/// One call of its own name and kept out of line, so that callgrind can be told to count it:
/// --toggle-collect=tarsusHotFrame.
extern "C" [[gnu::noinline]] void tarsusHotFrame(const std::function<void()>& work) { work(); }

namespace {

void runFrame(Clock& clock, std::size_t i, const Options& options, std::function<void()> work) {
  clock.time([&] {
    if (static_cast<int>(i) == options.hot_frame) {
      tarsusHotFrame(work);
    } else {
      work();
    }
  });
}

void integrate(const Options& options) {
  const LoadedScan scan = load(options);
  const double before_mb = peakMemory_mb();
  TsdfVolume volume(volumeOptions(options));
  Clock clock;
  for (std::size_t i = 0; i < scan.frames.size(); ++i) {
    runFrame(
        clock, i, options, [&] { volume.integrate(scan.camera, scan.frames[i], scan.pose(i)); });
  }
  const double work_mb = peakMemory_mb() - before_mb;
  const double touched = options.hot_frame < 0 ? touchedVoxels(scan, options) : 0.0;
  writeSurface(volume, options);
  print(clock,
        work_mb,
        volume.blockCount(),
        "\"touched_voxels\": " + std::to_string(touched) + ", \"trajectory_rmse_mm\": 0");
}

/// One session that goes through the scan.
struct StreamPass {
  StreamPass(const LoadedScan& loaded, const Options& bench_options, double preview_hz)
      : scan(loaded),
        options(bench_options),
        session(scan.camera, trackingOptions(options), {preview_hz}) {
    if (options.pipelined) {
      prepare(0);
    }
  }

  void push(std::size_t i) {
    runFrame(clock, i, options, [&] {
      const LiveFrame frame = options.pipelined ? pushPrepared(i) : session.push(scan.frames[i]);
      trajectory.push_back(frame.pose);
      meshed_blocks += frame.meshed_blocks;
      previews += frame.meshed_blocks > 0 ? 1 : 0;
    });
  }

  static TrackingOptions trackingOptions(const Options& bench_options) {
    TrackingOptions tracking;
    tracking.voxel_size_mm = bench_options.voxel_size_mm;
    tracking.max_depth_mm = std::min(tracking.max_depth_mm, bench_options.far_mm);
    return tracking;
  }
  void prepare(std::size_t i) {
    if (i < scan.frames.size()) {
      ready = std::async(std::launch::async, [this, i] { return session.prepare(scan.frames[i]); });
    }
  }
  LiveFrame pushPrepared(std::size_t i) {
    const PreparedFrame frame = ready.get();
    prepare(i + 1);
    return session.push(frame);
  }

  const LoadedScan& scan;
  const Options& options;
  LiveSession session;
  Clock clock;
  Trajectory trajectory;
  int meshed_blocks = 0;
  int previews = 0;  ///< frames after which the preview was renewed
  std::future<PreparedFrame> ready;
};

std::string previewFigures(const StreamPass& run) {
  const std::vector<double>& times = run.clock.wall_ms;
  return ", \"preview_mean_ms\": " + std::to_string(run.clock.mean_ms()) +
         ", \"preview_cpu_ms\": " + std::to_string(run.clock.cpu_ms / run.clock.frames()) +
         ", \"preview_frames_per_s\": " + std::to_string(1000.0 / run.clock.mean_ms()) +
         ", \"preview_worst_ms\": " +
         std::to_string(*std::max_element(times.begin(), times.end())) +
         ", \"preview_rounds\": " + std::to_string(run.previews) +
         ", \"preview_blocks\": " + std::to_string(run.meshed_blocks);
}

/// Both passes frame by frame in turn, so that whatever else the computer does slows both alike.
void stream(const Options& options) {
  const LoadedScan scan = load(options);
  const double before_mb = peakMemory_mb();
  StreamPass plain(scan, options, 0.0);
  std::optional<StreamPass> live;
  if (options.preview_hz > 0.0) {
    live.emplace(scan, options, options.preview_hz);
  }
  for (std::size_t i = 0; i < scan.frames.size(); ++i) {
    plain.push(i);
    if (live) {
      live->push(i);
    }
  }
  const TsdfVolume& model = plain.session.tracker().model();
  const double work_mb = peakMemory_mb() - before_mb;
  writeSurface(model, options);
  const TrajectoryError error = trajectoryError(plain.trajectory, scan.truth);
  std::string further =
      "\"lost\": " + std::to_string(static_cast<int>(scan.frames.size()) - error.poses) +
      ", \"trajectory_rmse_mm\": " + std::to_string(error.rms_mm) +
      ", \"trajectory_max_mm\": " + std::to_string(error.farthest_mm) +
      ", \"frames_per_s\": " + std::to_string(1000.0 / plain.clock.mean_ms());
  if (live) {
    further += previewFigures(*live);
  }
  print(plain.clock, work_mb, model.blockCount(), further);
}

/// Root mean square distance of the vertices of one mesh from the other, those farther than 10 mm
/// left out: what the foot's truth does not hold (table, support) is not the model's error.
void compare(const Options& options) {
  constexpr double kFarthest_mm = 10.0;
  const TexturedMesh model = orExit(readPly(options.scan));
  const TexturedMesh truth = orExit(readPly(options.reference));
  const MeshIndex index(truth.mesh);
  double squares = 0.0;
  std::size_t near = 0;
  for (const auto& vertex : model.mesh.vertices) {
    if (const auto nearest = index.nearest(vertex.cast<double>(), kFarthest_mm)) {
      squares += nearest->distance_mm * nearest->distance_mm;
      ++near;
    }
  }
  std::printf("{\"model_rms_mm\": %.4f, \"near_vertices\": %zu, \"vertices\": %zu}\n",
              std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, near))),
              near,
              model.mesh.vertices.size());
}

void addOptions(CLI::App& command, Options& options) {
  command.add_option("scan", options.scan)->required();
  command.add_option("--voxel-mm", options.voxel_size_mm);
  command.add_option("--delta-mm", options.delta_mm, "half of the band; integrate only");
  command.add_option("--far-mm", options.far_mm, "depth beyond is not looked at");
  command.add_option("--frames", options.frames, "the first so many");
  command.add_option("--hot-frame", options.hot_frame, "number of the frame for callgrind");
  command.add_flag("--color", options.color, "colour is fused; integrate only");
  command.add_option("--mesh", options.mesh, "write the surface there");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Times the hot loops on frames in memory; prints JSON");
  app.require_subcommand(1);
  Options options;
  CLI::App* const integrating = app.add_subcommand("integrate", "fusion alone, true poses");
  CLI::App* const streaming = app.add_subcommand("stream", "tracking and fusion");
  CLI::App* const comparing = app.add_subcommand("compare", "model against truth");
  addOptions(*integrating, options);
  addOptions(*streaming, options);
  comparing->add_option("model", options.scan)->required();
  comparing->add_option("truth", options.reference)->required();
  streaming->add_option("--preview-hz", options.preview_hz, "a second session, with the preview");
  streaming->add_flag("--pipelined", options.pipelined, "planes of the next frame meanwhile");
  CLI11_PARSE(app, argc, argv);
  if (integrating->parsed()) {
    integrate(options);
  } else if (streaming->parsed()) {
    stream(options);
  } else {
    compare(options);
  }
  return 0;
}
