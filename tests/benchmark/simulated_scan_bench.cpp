#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/fusion/fusion.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/mesh_picture.h"
#include "tests/benchmark/bench_support.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

/// Renders on demand and counts the processor time of that, which is not the product's.
class TimedSimulator : public FrameSource {
 public:
  explicit TimedSimulator(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}
  [[nodiscard]] const RgbdCamera& camera() const override { return source_->camera(); }
  [[nodiscard]] std::optional<int> frameCount() const override { return source_->frameCount(); }
  [[nodiscard]] const Warnings& warnings() const override { return source_->warnings(); }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    const StopWatch watch;
    auto frame = source_->next();
    cpu_s_ += watch.cpu_s();
    return frame;
  }
  [[nodiscard]] double cpu_s() const { return cpu_s_; }

 private:
  std::unique_ptr<FrameSource> source_;
  double cpu_s_ = 0.0;
};

/// Whether points lie inside a closed curve, seen along the normal of the plane through it.
class CurveInterior {
 public:
  explicit CurveInterior(const std::vector<Eigen::Vector3d>& curve) {
    for (const Eigen::Vector3d& p : curve) {
      center_ += p / static_cast<double>(curve.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : curve) {
      spread += (p - center_) * (p - center_).transpose();
      radius_ = std::max(radius_, (p - center_).norm());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
    across_ = eigen.eigenvectors().col(2);
    along_ = eigen.eigenvectors().col(1);
    for (const Eigen::Vector3d& p : curve) {
      polygon_.push_back(flat(p));
    }
  }
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    if ((p - center_).norm() > 1.5 * radius_) {
      return false;
    }
    const Eigen::Vector2d q = flat(p);
    bool inside = false;
    for (std::size_t i = 0, j = polygon_.size() - 1; i < polygon_.size(); j = i++) {
      const Eigen::Vector2d& a = polygon_[i];
      const Eigen::Vector2d& b = polygon_[j];
      if ((a.y() > q.y()) != (b.y() > q.y()) &&
          q.x() < (b.x() - a.x()) * (q.y() - a.y()) / (b.y() - a.y()) + a.x()) {
        inside = !inside;
      }
    }
    return inside;
  }

 private:
  [[nodiscard]] Eigen::Vector2d flat(const Eigen::Vector3d& p) const {
    return {across_.dot(p - center_), along_.dot(p - center_)};
  }
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d across_ = Eigen::Vector3d::UnitX();
  Eigen::Vector3d along_ = Eigen::Vector3d::UnitY();
  double radius_ = 0.0;
  std::vector<Eigen::Vector2d> polygon_;
};

/// Root mean square over frames of how far points on the foot move from where they are.
void printPointMotion(const Trajectory& trajectory, const SimulatedScene& scene) {
  double squares = 0.0;
  int count = 0;
  const auto& vertices = scene.foot.mesh.vertices;
  const std::size_t step = std::max<std::size_t>(1, vertices.size() / 200);
  std::optional<RigidTransform> anchor;
  for (const FramePose& pose : trajectory) {
    if (!pose.scan_from_camera) {
      continue;
    }
    const RigidTransform& truth =
        *scene.trajectory.at(static_cast<std::size_t>(pose.frame_index)).scan_from_camera;
    if (!anchor) {
      anchor = *pose.scan_from_camera * truth.inverse();
    }
    const RigidTransform moved = *pose.scan_from_camera * truth.inverse() * anchor->inverse();
    for (std::size_t i = 0; i < vertices.size(); i += step) {
      const Eigen::Vector3d p = vertices[i].cast<double>();
      squares += (moved * p - p).squaredNorm();
      ++count;
    }
  }
  std::printf("motion of points [mm]       %8.3f\n", std::sqrt(squares / std::max(1, count)));
}

/// Model vertices nearer to the foot than to what is around it: their distance from the foot.
Distances modelToFoot(const TriangleMesh& model, const SimulatedScene& scene) {
  const MeshIndex foot(scene.foot.mesh);
  const MeshIndex around(scene.surroundings.mesh);
  Distances distances;
  for (std::size_t i = 0; i < model.vertices.size(); i += 5) {
    const Eigen::Vector3d p = model.vertices[i].cast<double>();
    const auto near_foot = foot.nearest(p, 10.0);
    const auto near_other = around.nearest(p, 10.0);
    if (near_foot && (!near_other || near_foot->distance_mm < near_other->distance_mm)) {
      distances.values_mm.push_back(near_foot->distance_mm);
    }
  }
  return distances;
}

/// True bed inside the outline: distance of its vertices from the model.
void printWounds(const TriangleMesh& model, const SimulatedScene& scene) {
  const MeshIndex index(model);
  for (const WoundTruth& wound : scene.wounds) {
    const CurveInterior interior(wound.outline_mm);
    Distances distances;
    Distances signed_depths;
    for (const Eigen::Vector3f& vertex : scene.foot.mesh.vertices) {
      const Eigen::Vector3d p = vertex.cast<double>();
      if (interior.contains(p)) {
        const auto nearest = index.nearest(p, 20.0);
        distances.values_mm.push_back(nearest ? nearest->distance_mm : 20.0);
      }
    }
    distances.print(("wound region, " + wound.site).c_str());
  }
}

SimulatorOptions optionsOf(const BenchArguments& arguments) {
  SimulatorOptions options;
  const auto foot = footCaseNamed(arguments.input);
  if (!foot) {
    orExit(Expected<void>(fail(ErrorCode::BadOption, "no simulated foot " + arguments.input)));
  }
  options.foot = *foot;
  options.frames = arguments.frames;
  options.seed = arguments.seed;
  return options;
}

void savePictures(const BenchArguments& arguments,
                  const ExtractedSurface& surface,
                  const SimulatedScene& scene) {
  if (arguments.pictures.empty()) {
    return;
  }
  PictureOptions picture;
  ViewFrame view =
      viewOfWhole(scene.foot.mesh, -Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY(), picture);
  orExit(writeColorImage(arguments.pictures / "simulated_color.png",
                         takePicture(surface.mesh, surface.colors, view, picture),
                         Flush::Later));
  picture.textured = false;
  orExit(writeColorImage(arguments.pictures / "simulated_relief.png",
                         takePicture(surface.mesh, {}, view, picture),
                         Flush::Later));
  if (!scene.wounds.empty()) {
    view.center_mm = scene.wounds.front().center_mm;
    view.mm_per_px = 0.06;
    orExit(writeColorImage(arguments.pictures / "simulated_wound.png",
                           takePicture(surface.mesh, {}, view, picture),
                           Flush::Later));
  }
}

}  // namespace

void benchSimulated(const BenchArguments& arguments) {
  const SimulatorOptions options = optionsOf(arguments);
  const auto scene = orExit(buildScene(options));
  TimedSimulator first(openSimulator(scene, options));
  const StopWatch tracking;
  const TrackingResult tracked = orExit(trackScan(first, {}, {}));
  const int frames = tracked.frames_tracked + tracked.frames_lost;
  std::printf(
      "tracked                     %8d of %d frames, %d relocalisations, residual %.2f mm\n",
      tracked.frames_tracked,
      frames,
      tracked.relocalisations,
      tracked.rmse_mm);
  std::printf("tracking                    %8.1f ms of processor a frame, rendering left out\n",
              1000.0 * (tracking.cpu_s() - first.cpu_s()) / frames);
  printLostFrames(tracked.trajectory);
  printTrajectoryError(tracked.trajectory, scene->trajectory);
  printPointMotion(tracked.trajectory, *scene);

  TimedSimulator second(openSimulator(scene, options));
  TsdfOptions volume_options;
  volume_options.voxel_size_mm = arguments.voxel_size_mm;
  const StopWatch fusing;
  const TsdfVolume volume = orExit(fuseScan(second, tracked.trajectory, volume_options, {}));
  std::printf("fusion                      %8.1f ms of processor a frame, rendering left out\n",
              1000.0 * (fusing.cpu_s() - second.cpu_s()) / frames);
  std::printf("volume                      %8zu MB, %d blocks\n",
              volume.memoryBytes() >> 20U,
              volume.blockCount());
  const StopWatch extracting;
  const ExtractedSurface surface =
      removeSmallComponents(volume.extractSurface(3.0F), {.min_faces = 500});
  std::printf("surface                     %8.1f s of processor, %zu faces, %d holes\n",
              extracting.cpu_s(),
              surface.mesh.faces.size(),
              countHoles(surface.mesh));
  modelToFoot(surface.mesh, *scene).print("model to true foot");
  printWounds(surface.mesh, *scene);
  savePictures(arguments, surface, *scene);
}

}  // namespace tarsus
