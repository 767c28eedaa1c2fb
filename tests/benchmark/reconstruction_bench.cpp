// Tables of figures on whole scans; the last line of this file says how to call it.

#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/pose_refinement.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/fusion/surface_refinement.h"
#include "reconstruction/pipeline/reconstruct.h"
#include "reconstruction/scene/mesh_distance.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/mesh_picture.h"
#include "reconstruction/scene/ply.h"
#include "tests/benchmark/bench_support.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace {

using namespace tarsus;  // NOLINT: a program of its own

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

/// Distances of every fourth measured pixel (both ways) from the model.
Distances framesToModel(const Scan& scan, const Trajectory& trajectory, const TriangleMesh& mesh) {
  const MeshIndex index(mesh);
  Distances errors;
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
        errors.values_mm.push_back(nearest ? nearest->distance_mm : 50.0);
      }
    }
  }
  return errors;
}

/// Points farther off belong to what the model rightly left out: flying pixels, single views.
void printFramesToModel(const Distances& distances) {
  distances.printWithin("frames to model RMS [mm]", 5.0);
  distances.print("  all, capped at 50 mm");
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

ExtractedSurface fuseAndExtract(const Scan& scan, const TrackedScan& tracked, float min_weight) {
  TsdfOptions options;
  options.voxel_size_mm = scan.voxel_size_mm;
  options.with_color = false;
  const StopWatch fusing;
  const TsdfVolume volume = orExit(fuseScan(tracked.archive, tracked.trajectory, {}, options, {}));
  std::printf(
      "fusion                      %8.1f s  (processor %.1f s)\n", fusing.wall_s(), fusing.cpu_s());
  std::printf("volume                      %8zu MB, %d blocks of 8^3 voxels of %.2f mm\n",
              volume.memoryBytes() >> 20U,
              volume.blockCount(),
              scan.voxel_size_mm);
  const StopWatch extracting;
  ExtractedSurface surface =
      removeSmallComponents(volume.extractSurface(min_weight), {.min_faces = 500});
  surface = orExit(refineSurface(std::move(surface), tracked.archive, tracked.trajectory, {}, {}));
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

void refine(TrackedScan& tracked) {
  const StopWatch watch;
  tracked.trajectory =
      orExit(refinePoses(tracked.model, tracked.points, tracked.trajectory, {}, {})).trajectory;
  std::printf(
      "refinement of all poses     %8.1f s  (processor %.1f s)\n", watch.wall_s(), watch.cpu_s());
}

TrackedScan track(const Scan& scan) {
  const auto frames = scan.open(true);
  const StopWatch watch;
  TrackedScan result = orExit(trackScan(*frames, {}, {}));
  const int count = static_cast<int>(result.trajectory.size());
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
  TrackedScan tracked = track(scan);
  printLostFrames(tracked.trajectory);
  printTrajectoryError(tracked.trajectory, scan.reference());
  refine(tracked);
  printTrajectoryError(tracked.trajectory, scan.reference());
  const ExtractedSurface surface = fuseAndExtract(scan, tracked, 3.0F);
  printFramesToModel(framesToModel(scan, tracked.trajectory, surface.mesh));
  const std::array views{Eigen::Vector3d(0, -0.4, -1), Eigen::Vector3d(0.8, -0.6, -1)};
  savePictures(scan, surface, "tabletop", views);
}

void benchBust(const Scan& scan) {
  const Trajectory poses = scan.reference();
  const auto frames = scan.open(true);
  const TrackedScan placed = orExit(placeScan(*frames, poses, {}, {}));
  const ExtractedSurface surface = fuseAndExtract(scan, placed, 2.0F);
  printFramesToModel(framesToModel(scan, poses, surface.mesh));
  const std::array views{Eigen::Vector3d(0, 0, -1),
                         Eigen::Vector3d(1, 0, 0),
                         Eigen::Vector3d(0, 0, 1),
                         Eigen::Vector3d(-1, -0.5, 0)};
  savePictures(scan, surface, "bust", views);
}

/// Known poses made wrong by 5 mm and 1 degree each, a direction of its own for every frame (the
/// first keeps its own), and refined again from there by the whole pipeline.
void benchPerturbed(const Scan& scan) {
  const Trajectory truth = scan.reference();
  std::mt19937 dice(7);
  const auto direction = [&dice] {
    const auto part = [&dice] { return static_cast<double>(dice()) / 4294967296.0 - 0.5; };
    return Eigen::Vector3d(part(), part(), part()).normalized();
  };
  ScanOptions options{.texture = false, .keep_background = true, .refine_trajectory = true};
  options.surface.voxel_size_mm = scan.voxel_size_mm;
  options.min_weight = 2.0F;
  options.trajectory = truth;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    RigidTransform& pose = *(*options.trajectory)[i].scan_from_camera;
    pose.translation() += 5.0 * direction();
    pose.linear() = pose.linear() * Eigen::AngleAxisd(std::numbers::pi / 180.0, direction());
  }
  printTrajectoryError(*options.trajectory, truth);
  const ScanOpener open = [&](const FrameContent& content) {
    return openScanFolder(scan.folder, {}, content);
  };
  const Reconstruction result = orExit(reconstructScan(open, options, {}));
  printTrajectoryError(result.trajectory, truth);
  ExtractedSurface surface;
  surface.mesh = result.model.mesh;
  printFramesToModel(framesToModel(scan, result.trajectory, surface.mesh));
}

Scan scanOf(const BenchArguments& arguments) {
  return {.folder = arguments.input,
          .pictures = arguments.pictures,
          .voxel_size_mm = arguments.voxel_size_mm};
}

struct Benchmark {
  std::string_view name;
  void (*run)(const BenchArguments&);
};

constexpr std::array kBenchmarks{
    Benchmark{"tabletop", [](const BenchArguments& a) { benchTabletop(scanOf(a)); }},
    Benchmark{"bust", [](const BenchArguments& a) { benchBust(scanOf(a)); }},
    Benchmark{"perturbed", [](const BenchArguments& a) { benchPerturbed(scanOf(a)); }}};

/// `--pictures DIR --voxel-mm X`, in any order.
BenchArguments parse(std::span<char*> arguments) {
  BenchArguments result;
  result.input = arguments[0];
  for (std::size_t i = 1; i + 1 < arguments.size(); i += 2) {
    const std::string_view option = arguments[i];
    const std::string value = arguments[i + 1];
    if (option == "--pictures") {
      result.pictures = value;
    } else if (option == "--voxel-mm") {
      result.voxel_size_mm = std::stod(value);
    }
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  for (const Benchmark& benchmark : kBenchmarks) {
    if (argc >= 3 && benchmark.name == arguments[1]) {
      const BenchArguments given = parse(arguments.subspan(2));
      const StopWatch watch;
      std::printf("%s at %.2f mm\n", arguments[1], given.voxel_size_mm);
      benchmark.run(given);
      std::printf("in all                      %8.1f s  (processor %.1f s), peak memory %.0f MB\n",
                  watch.wall_s(),
                  watch.cpu_s(),
                  peakMemory_mb());
      return 0;
    }
  }
  std::fprintf(
      stderr,
      "usage: tarsus-bench tabletop|bust|perturbed SCAN_FOLDER [--pictures DIR] [--voxel-mm 1]\n");
  return 2;
}
