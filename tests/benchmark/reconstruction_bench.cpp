// Tables of figures on whole scans: `tarsus-bench tabletop DIR [PICTURES]`, `... bust DIR`, ...
// Definitions: design.md section 5 of the project's papers; README.md beside this file's results.

#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/fusion.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/scene/mesh_distance.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/mesh_picture.h"
#include "reconstruction/scene/ply.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace {

using namespace tarsus;  // NOLINT: a program of its own

/// Wall and processor time since it was made.
class StopWatch {
 public:
  [[nodiscard]] double wall_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }
  [[nodiscard]] double cpu_s() const {
    return static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC;
  }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  std::clock_t cpu_ = std::clock();
};

double peakMemory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

template <typename T>
T orExit(Expected<T> value) {
  if (!value) {
    std::fprintf(stderr, "tarsus-bench: %s\n", describe(value.error()).c_str());
    std::exit(1);
  }
  if constexpr (!std::is_void_v<T>) {
    return std::move(*value);
  }
}

/// What a benchmark on one scan needs.
struct Scan {
  std::filesystem::path folder;
  std::filesystem::path pictures;  ///< empty: none
  double voxel_size_mm = 1.0;

  [[nodiscard]] std::unique_ptr<FrameSource> open(bool color) const {
    return orExit(openScanFolder(folder, {}, {.color = color}));
  }
  [[nodiscard]] Trajectory reference() const {
    return orExit(readTrajectory(folder / "groundtruth.txt"));
  }
};

constexpr std::chrono::microseconds kSameTime{2000};

/// Camera positions against the reference, first tracked pose anchored, no further alignment.
void printTrajectoryError(const Trajectory& trajectory, const Trajectory& reference) {
  std::optional<RigidTransform> scan_from_reference;
  double squares = 0.0;
  double farthest = 0.0;
  int count = 0;
  for (const FramePose& pose : trajectory) {
    const auto truth = poseAt(reference, pose.timestamp, kSameTime);
    if (!pose.scan_from_camera || !truth) {
      continue;
    }
    if (!scan_from_reference) {
      scan_from_reference = *pose.scan_from_camera * truth->inverse();
    }
    const double error = (*scan_from_reference * truth->translation() -
                          Eigen::Vector3d(pose.scan_from_camera->translation()))
                             .norm();
    squares += error * error;
    farthest = std::max(farthest, error);
    ++count;
  }
  std::printf("trajectory RMSE [mm]        %8.2f   farthest %.2f, over %d poses\n",
              std::sqrt(squares / std::max(1, count)),
              farthest,
              count);
}

struct PointErrors {
  std::vector<double> distances_mm;

  void print(double limit_mm) const {
    double all = 0.0;
    double near = 0.0;
    std::size_t inside = 0;
    for (const double d : distances_mm) {
      all += d * d;
      if (d <= limit_mm) {
        near += d * d;
        ++inside;
      }
    }
    const auto n = static_cast<double>(std::max<std::size_t>(1, distances_mm.size()));
    std::printf(
        "frames to model RMS [mm]    %8.3f   points within %.0f mm of it; %.2f %% excluded\n",
        std::sqrt(near / std::max(1.0, static_cast<double>(inside))),
        limit_mm,
        100.0 * (1.0 - static_cast<double>(inside) / n));
    std::printf("  all points, capped 50 mm  %8.3f   %zu points\n",
                std::sqrt(all / n),
                distances_mm.size());
    std::vector<double> sorted = distances_mm;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty()) {
      std::printf("  median / 95 %%             %8.3f / %.3f\n",
                  sorted[sorted.size() / 2],
                  sorted[sorted.size() * 95 / 100]);
    }
  }
};

/// Distances of every fourth measured pixel (both ways) from the model.
PointErrors framesToModel(const Scan& scan,
                          const Trajectory& trajectory,
                          const TriangleMesh& mesh) {
  const MeshIndex index(mesh);
  PointErrors errors;
  const auto frames = scan.open(false);
  while (const auto frame = orExit(frames->next())) {
    const auto pose = poseAt(trajectory, frame->timestamp, kSameTime);
    if (!pose) {
      continue;
    }
    for (int v = 0; v < frame->depth.height(); v += 4) {
      for (int u = 0; u < frame->depth.width(); u += 4) {
        const double z = static_cast<double>(frame->depth.at(u, v));
        if (z < 100.0 || z > 1500.0) {
          continue;
        }
        const Eigen::Vector3d p = *pose * Eigen::Vector3d(frames->camera().depth.ray(u, v) * z);
        const auto nearest = index.nearest(p, 50.0);
        errors.distances_mm.push_back(nearest ? nearest->distance_mm : 50.0);
      }
    }
  }
  return errors;
}

void savePictures(const Scan& scan,
                  const ExtractedSurface& surface,
                  const std::string& name,
                  std::span<const Eigen::Vector3d> toward_viewer) {
  if (scan.pictures.empty()) {
    return;
  }
  int number = 0;
  for (const Eigen::Vector3d& direction : toward_viewer) {
    PictureOptions options;
    const ViewFrame view = viewOfWhole(surface.mesh, direction, -Eigen::Vector3d::UnitY(), options);
    for (const bool textured : {true, false}) {
      options.textured = textured;
      const ColorImage picture = takePicture(surface.mesh, surface.colors, view, options);
      const std::string file =
          name + "_" + std::to_string(number) + (textured ? "_color.png" : "_relief.png");
      orExit(writeColorImage(scan.pictures / file, picture, Flush::Later));
    }
    ++number;
  }
  TexturedMesh model;
  model.mesh = surface.mesh;
  model.colors = surface.colors;
  model.sigma_mm = surface.sigma_mm;
  model.observations = surface.observations;
  orExit(writePly(scan.pictures / (name + ".ply"), model));
}

ExtractedSurface fuseAndExtract(const Scan& scan, const Trajectory& trajectory, float min_weight) {
  TsdfOptions options;
  options.voxel_size_mm = scan.voxel_size_mm;
  const auto frames = scan.open(true);
  const StopWatch fusing;
  const TsdfVolume volume = orExit(fuseScan(*frames, trajectory, options, {}));
  std::printf(
      "fusion, reading included    %8.1f s  (processor %.1f s)\n", fusing.wall_s(), fusing.cpu_s());
  std::printf("volume                      %8zu MB, %d blocks of 8^3 voxels of %.2f mm\n",
              volume.memoryBytes() >> 20U,
              volume.blockCount(),
              scan.voxel_size_mm);
  const StopWatch extracting;
  ExtractedSurface surface =
      removeSmallComponents(volume.extractSurface(min_weight), {.min_faces = 500});
  std::printf(
      "surface                     %8.1f s  (processor %.1f s), %zu vertices, %zu faces, %d "
      "holes\n",
      extracting.wall_s(),
      extracting.cpu_s(),
      surface.mesh.vertices.size(),
      surface.mesh.faces.size(),
      countHoles(surface.mesh));
  return surface;
}

TrackingResult track(const Scan& scan) {
  const auto frames = scan.open(false);
  const StopWatch watch;
  TrackingResult result = orExit(trackScan(*frames, {}, {}));
  const int count = result.frames_tracked + result.frames_lost;
  std::printf(
      "tracked                     %8d of %d frames, %d relocalisations, residual %.2f mm\n",
      result.frames_tracked,
      count,
      result.relocalisations,
      result.rmse_mm);
  std::printf("tracking, reading included  %8.1f s  (processor %.1f s, %.1f ms a frame)\n",
              watch.wall_s(),
              watch.cpu_s(),
              1000.0 * watch.cpu_s() / std::max(1, count));
  return result;
}

void benchTabletop(const Scan& scan) {
  const TrackingResult tracked = track(scan);
  for (const FramePose& pose : tracked.trajectory) {
    if (!pose.scan_from_camera) {
      std::printf("  lost: frame %d, residual %.2f mm, inliers %.2f\n",
                  pose.frame_index,
                  pose.rmse_mm,
                  pose.inlier_fraction);
    }
  }
  printTrajectoryError(tracked.trajectory, scan.reference());
  const ExtractedSurface surface = fuseAndExtract(scan, tracked.trajectory, 3.0F);
  framesToModel(scan, tracked.trajectory, surface.mesh).print(5.0);
  const std::array views{Eigen::Vector3d(0, -0.4, -1), Eigen::Vector3d(0.8, -0.6, -1)};
  savePictures(scan, surface, "tabletop", views);
}

void benchBust(const Scan& scan) {
  const Trajectory poses = scan.reference();
  const ExtractedSurface surface = fuseAndExtract(scan, poses, 2.0F);
  framesToModel(scan, poses, surface.mesh).print(5.0);
  const std::array views{Eigen::Vector3d(0, 0, -1),
                         Eigen::Vector3d(1, 0, 0),
                         Eigen::Vector3d(0, 0, 1),
                         Eigen::Vector3d(-1, -0.5, 0)};
  savePictures(scan, surface, "bust", views);
}

struct Benchmark {
  std::string_view name;
  void (*run)(const Scan&);
};

constexpr std::array kBenchmarks{Benchmark{"tabletop", benchTabletop},
                                 Benchmark{"bust", benchBust}};

}  // namespace

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  for (const Benchmark& benchmark : kBenchmarks) {
    if (argc >= 3 && benchmark.name == arguments[1]) {
      Scan scan{.folder = arguments[2], .pictures = {}};
      scan.pictures = argc >= 4 ? arguments[3] : "";
      scan.voxel_size_mm = argc >= 5 ? std::stod(arguments[4]) : 1.0;
      const StopWatch watch;
      std::printf("%s at %.2f mm\n", arguments[1], scan.voxel_size_mm);
      benchmark.run(scan);
      std::printf("in all                      %8.1f s  (processor %.1f s), peak memory %.0f MB\n",
                  watch.wall_s(),
                  watch.cpu_s(),
                  peakMemory_mb());
      return 0;
    }
  }
  std::fprintf(stderr,
               "usage: tarsus-bench tabletop|bust SCAN_FOLDER [PICTURE_FOLDER [VOXEL_MM]]\n");
  return 2;
}
