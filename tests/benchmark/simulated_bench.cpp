// How near a reconstruction of a simulated scan comes to the truth:
//   tarsus-bench-simulated SCAN_DIR MODEL_DIR
// SCAN_DIR as `tarsus-cli simulate` writes it, MODEL_DIR as `tarsus-cli reconstruct` does.

#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/scene/mesh_distance.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/ply.h"
#include "reconstruction/scene/rigid_fit.h"
#include "tests/benchmark/bench_support.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>

namespace {

using namespace tarsus;  // NOLINT: a program of its own

constexpr std::chrono::microseconds kSameTime{2000};

struct PosePair {
  RigidTransform estimated;
  RigidTransform truth;
};

/// Poses of the tracked frames; the first is the identity in both, so both are anchored there.
std::vector<PosePair> pairPoses(const Trajectory& estimated, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  for (const FramePose& pose : estimated) {
    if (const auto true_pose = poseAt(truth, pose.timestamp, kSameTime)) {
      pairs.push_back({*pose.scan_from_camera, *true_pose});
    }
  }
  if (!pairs.empty()) {
    const RigidTransform anchor = pairs[0].estimated * pairs[0].truth.inverse();
    for (PosePair& pair : pairs) {
      pair.truth = anchor * pair.truth;
    }
  }
  return pairs;
}

double rootMeanSquare(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, values.size())));
}

void printRow(const char* name, const std::vector<double>& values) {
  const double largest = values.empty() ? 0.0 : *std::ranges::max_element(values);
  std::printf("%-34s %8.3f mm RMS, %8.3f mm at most\n", name, rootMeanSquare(values), largest);
}

void printPoseErrors(const std::vector<PosePair>& pairs, const TriangleMesh& foot) {
  std::vector<double> positions;
  std::vector<double> points;
  const std::size_t step = std::max<std::size_t>(1, foot.vertices.size() / 200);
  for (const PosePair& pair : pairs) {
    positions.push_back((pair.estimated.translation() - pair.truth.translation()).norm());
    const RigidTransform difference = pair.estimated * pair.truth.inverse();
    for (std::size_t i = 0; i < foot.vertices.size(); i += step) {
      const Eigen::Vector3d p = foot.vertices[i].cast<double>();
      points.push_back((difference * p - p).norm());
    }
  }
  printRow("camera positions", positions);
  printRow("motion of points at the foot", points);
}

/// Whether a point of the true foot was seen by one of the cameras, at less than 75 degrees.
bool seen(const MeshIndex& index,
          const std::vector<PosePair>& cameras,
          const Intrinsics& intrinsics,
          const Eigen::Vector3d& p,
          const Eigen::Vector3d& normal) {
  const double min_cosine = std::cos(75.0 * std::numbers::pi / 180.0);
  for (std::size_t i = 0; i < cameras.size(); i += 10) {
    const Eigen::Vector3d origin = cameras[i].truth.translation();
    const Eigen::Vector3d p_camera = cameras[i].truth.inverse() * p;
    const Eigen::Vector3d ray = p - origin;
    if (p_camera.z() <= 0.0 || -ray.normalized().dot(normal) < min_cosine) {
      continue;
    }
    const Eigen::Vector2d pixel = intrinsics.project(p_camera);
    const bool inside = pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= intrinsics.width - 1 &&
                        pixel.y() <= intrinsics.height - 1;
    if (inside && index.castRay(origin.cast<float>(), ray.cast<float>()).distance > 0.999F) {
      return true;
    }
  }
  return false;
}

void printCompleteness(const TexturedMesh& foot,
                       const TexturedMesh& model,
                       const std::vector<PosePair>& cameras,
                       const Intrinsics& intrinsics) {
  const MeshIndex true_index(foot.mesh);
  const MeshIndex model_index(model.mesh);
  const auto normals = vertexNormals(foot.mesh);
  int samples = 0;
  int found = 0;
  const std::size_t step = std::max<std::size_t>(1, foot.mesh.vertices.size() / 20'000);
  for (std::size_t i = 0; i < foot.mesh.vertices.size(); i += step) {
    const Eigen::Vector3d p = foot.mesh.vertices[i].cast<double>();
    if (seen(true_index, cameras, intrinsics, p, normals[i].cast<double>())) {
      ++samples;
      found += model_index.nearest(p, 1.0) ? 1 : 0;
    }
  }
  std::printf("%-34s %8.2f %% of %d seen samples\n",
              "completeness (1 mm)",
              100.0 * found / std::max(1, samples),
              samples);
}

/// Distances of the true bed to the model: the bed is where the carved foot leaves the intact one.
void printWoundRegion(const TriangleMesh& carved,
                      const TriangleMesh& intact,
                      const TriangleMesh& model) {
  const MeshIndex index(model);
  std::vector<double> distances;
  for (std::size_t i = 0; i < carved.vertices.size(); ++i) {
    if ((carved.vertices[i] - intact.vertices[i]).norm() > 1e-3F) {
      const auto nearest = index.nearest(carved.vertices[i].cast<double>(), 50.0);
      distances.push_back(nearest ? nearest->distance_mm : 50.0);
    }
  }
  printRow("wound region, bed to model", distances);
}

/// What lies between the intact skin and a bed, along the intact skin's normals.
struct Crater {
  double volume_mm3 = 0.0;
  double max_depth_mm = 0.0;
  int missed = 0;  ///< rays that met no bed
};

/// The wound is where the carved foot leaves the intact one: true outline and true skin for any
/// bed.
Crater craterOf(const TriangleMesh& carved, const TriangleMesh& intact, const MeshIndex& bed) {
  constexpr double kStart_mm = 2.0;
  constexpr double kDeepest_mm = 25.0;
  const auto normals = vertexNormals(intact);
  Crater crater;
  std::vector<double> depth(intact.vertices.size(), 0.0);
  for (std::size_t i = 0; i < intact.vertices.size(); ++i) {
    if ((carved.vertices[i] - intact.vertices[i]).norm() <= 1e-3F) {
      continue;
    }
    const auto hit =
        bed.castRay(intact.vertices[i] + static_cast<float>(kStart_mm) * normals[i], -normals[i]);
    const double found = hit.face < 0 ? kDeepest_mm : double{hit.distance} - kStart_mm;
    if (found >= kDeepest_mm) {
      ++crater.missed;
      continue;
    }
    depth[i] = found;
    crater.max_depth_mm = std::max(crater.max_depth_mm, found);
  }
  for (const Eigen::Vector3i& f : intact.faces) {
    const Eigen::Vector3d a = intact.vertices[static_cast<std::size_t>(f[0])].cast<double>();
    const Eigen::Vector3d b = intact.vertices[static_cast<std::size_t>(f[1])].cast<double>();
    const Eigen::Vector3d c = intact.vertices[static_cast<std::size_t>(f[2])].cast<double>();
    const double area = 0.5 * (b - a).cross(c - a).norm();
    crater.volume_mm3 +=
        area *
        (depth[static_cast<std::size_t>(f[0])] + depth[static_cast<std::size_t>(f[1])] +
         depth[static_cast<std::size_t>(f[2])]) /
        3.0;
  }
  return crater;
}

/// The model laid onto the true foot: what the first camera's own pose was off is gone.
TriangleMesh aligned(TriangleMesh model, const TriangleMesh& foot) {
  std::vector<Eigen::Vector3d> samples;
  for (std::size_t i = 0; i < model.vertices.size(); i += 5) {
    samples.push_back(model.vertices[i].cast<double>());
  }
  const RigidTransform motion = fitRigidly(samples, foot, MeshIndex(foot));
  for (Eigen::Vector3f& p : model.vertices) {
    p = (motion * p.cast<double>()).cast<float>();
  }
  return model;
}

/// Both beds by the same rays, so that what is left is the model's error alone.
void printVolume(const char* title,
                 const TriangleMesh& carved,
                 const TriangleMesh& intact,
                 const TriangleMesh& model) {
  const Crater truth = craterOf(carved, intact, MeshIndex(carved));
  const Crater found = craterOf(carved, intact, MeshIndex(model));
  std::printf("%-34s %8.1f of %.1f mm3 (%+.2f %%), %d rays missed\n",
              title,
              found.volume_mm3,
              truth.volume_mm3,
              100.0 * (found.volume_mm3 / truth.volume_mm3 - 1.0),
              found.missed);
  std::printf("%-34s %8.2f of %.2f mm (%+.2f)\n",
              "greatest depth below true skin",
              found.max_depth_mm,
              truth.max_depth_mm,
              found.max_depth_mm - truth.max_depth_mm);
}

void printBench(const std::filesystem::path& scan, const std::filesystem::path& model_folder) {
  const TexturedMesh carved = orExit(readPly(scan / "truth" / "mesh.ply"));
  const TexturedMesh intact = orExit(readPly(scan / "truth" / "intact.ply"));
  const TexturedMesh model = orExit(readPly(model_folder / "model.ply"));
  const Trajectory truth = orExit(readTrajectory(scan / "groundtruth.txt"));
  const Trajectory estimated = orExit(readTrajectory(model_folder / "trajectory.txt"));
  const RgbdCamera camera = orExit(readCamera(scan / "camera.json"));
  const auto pairs = pairPoses(estimated, truth);
  std::printf("%-34s %8zu of %zu\n", "frames tracked", pairs.size(), truth.size());
  printPoseErrors(pairs, carved.mesh);
  const auto comparison = orExit(compareMeshes(model.mesh, carved.mesh, {}));
  std::printf("%-34s %8.3f mm RMS, mean %.3f, 95 %% %.3f, farthest %.3f\n",
              "model to true foot",
              comparison.a_to_b.rms_mm,
              comparison.a_to_b.mean_mm,
              comparison.a_to_b.p95_mm,
              comparison.a_to_b.max_mm);
  printWoundRegion(carved.mesh, intact.mesh, model.mesh);
  printVolume("volume, true outline and skin", carved.mesh, intact.mesh, model.mesh);
  printVolume("  the same, model laid on the foot",
              carved.mesh,
              intact.mesh,
              aligned(model.mesh, carved.mesh));
  printCompleteness(carved, model, pairs, camera.depth);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: tarsus-bench-simulated SCAN_DIR MODEL_DIR\n");
    return 2;
  }
  printBench(argv[1], argv[2]);
  return 0;
}
