#include "tests/benchmark/texture_scan.h"

#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/fusion.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "reconstruction/fusion/surface_refinement.h"
#include "reconstruction/scene/ply.h"
#include "tests/benchmark/bench_support.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

namespace tarsus {
namespace {

constexpr std::chrono::microseconds kSameTime{2000};
constexpr int kKeyframes = 30;
constexpr int kLeftOut = 6;
/// A left-out frame so near to a keyframe would show what the keyframe has shown.
constexpr int kFramesApart = 4;
constexpr int kBustStep = 8;  ///< every eighth view of the bust is left out

[[noreturn]] void giveUp(const std::string& reason) {
  std::fprintf(stderr, "tarsus-bench-texture: %s\n", reason.c_str());
  std::exit(1);
}

/// The sharpest frame in the middle of each of six stretches of the path, none of them a keyframe.
std::vector<Keyframe> chooseLeftOut(FrameSource& frames,
                                    const Trajectory& trajectory,
                                    const std::vector<Keyframe>& keyframes) {
  const int total = frames.frameCount().value_or(0);
  std::vector<std::optional<Keyframe>> best(kLeftOut);
  while (auto frame = orExit(frames.next())) {
    const int thirds = frame->index * kLeftOut * 3 / std::max(total, 1);
    const auto pose = poseAt(trajectory, frame->timestamp, kSameTime);
    const bool near = std::ranges::any_of(keyframes, [&](const Keyframe& keyframe) {
      return std::abs(keyframe.frame.index - frame->index) < kFramesApart;
    });
    if (thirds % 3 != 1 || near || !pose) {
      continue;
    }
    std::optional<Keyframe>& chosen = best[static_cast<std::size_t>(thirds / 3)];
    const double blur = blurMeasure(frame->color);
    if (!chosen || blur < chosen->blur) {
      chosen = Keyframe{.frame = std::move(*frame), .scan_from_camera = *pose, .blur = blur};
    }
  }
  std::vector<Keyframe> result;
  for (std::optional<Keyframe>& chosen : best) {
    if (chosen) {
      result.push_back(std::move(*chosen));
    }
  }
  return result;
}

ExtractedSurface surfaceOf(TexturedMesh model) {
  return {.mesh = std::move(model.mesh),
          .colors = std::move(model.colors),
          .sigma_mm = std::move(model.sigma_mm),
          .observations = std::move(model.observations)};
}

/// The model's frame and the true scene's are one only where the first frame was tracked.
void requireSameOrigin(const Trajectory& trajectory) {
  if (trajectory.empty() || std::chrono::abs(trajectory[0].timestamp) > kSameTime ||
      !trajectory[0].scan_from_camera->isApprox(RigidTransform::Identity(), 1e-6)) {
    giveUp("the model does not begin with the scan's first frame; choose another scan");
  }
}

SimulatorOptions optionsOf(const nlohmann::json& json) {
  SimulatorOptions options;
  options.foot = footCaseNamed(json.at("foot").get<std::string>()).value();
  options.path = cameraPathNamed(json.at("path").get<std::string>()).value();
  options.layout = cameraLayoutNamed(json.at("camera").get<std::string>()).value();
  options.fault = scanFaultNamed(json.value("fault", std::string("none"))).value();
  options.frames = json.at("frames").get<int>();
  options.seed = json.at("seed").get<std::uint64_t>();
  options.noise = json.at("noise").get<double>();
  options.jitter_mm = json.at("jitter_mm").get<double>();
  options.mesh = json.at("mesh").get<std::string>();
  return options;
}

}  // namespace

TextureScan loadFoot(const std::filesystem::path& scan, const std::filesystem::path& model) {
  TextureScan result;
  const Trajectory trajectory = orExit(readTrajectory(model / "trajectory.txt"));
  requireSameOrigin(trajectory);
  result.surface = surfaceOf(orExit(readPly(model / "model.ply")));
  const auto frames = orExit(openScanFolder(scan));
  result.camera = frames->camera();
  std::vector<PictureQuality> pictures;
  while (const auto frame = orExit(frames->next())) {
    pictures.push_back(assessPicture(*frame));
  }
  const KeyframeOptions options{.target_count = kKeyframes, .most_count = kKeyframes};
  const KeyframeChoice choice = orExit(
      chooseKeyframes(pictures, trajectory, result.camera, result.surface.mesh, options, Job{}));
  result.keyframes =
      orExit(readKeyframes(*orExit(openScanFolder(scan, {}, contentFor(choice))), choice, Job{}));
  const auto again = orExit(openScanFolder(scan));
  result.left_out = chooseLeftOut(*again, trajectory, result.keyframes);
  return result;
}

TrueScene loadTrueScene(const std::filesystem::path& scan) {
  const std::filesystem::path path = scan / "truth" / "truth.json";
  std::ifstream file(path);
  const nlohmann::json truth = nlohmann::json::parse(file, nullptr, false);
  if (truth.is_discarded()) {
    giveUp(path.string() + " is missing or broken; simulate the scan anew");
  }
  auto scene = orExit(buildScene(optionsOf(truth.at("options"))));
  return {.scene = scene, .renderer = Renderer(scene)};
}

namespace {

bool isLeftOut(const FramePose& pose) { return pose.frame_index % kBustStep == kBustStep / 2; }

}  // namespace

TextureScan loadBust(const std::filesystem::path& scan, double voxel_size_mm) {
  const Trajectory poses = orExit(readTrajectory(scan / "groundtruth.txt"));
  Trajectory kept = poses;  // not even the surface is made from what judges it
  std::erase_if(kept, isLeftOut);
  TextureScan result;
  {
    const auto frames = orExit(openScanFolder(scan));
    result.camera = frames->camera();
    const TrackedScan placed = orExit(placeScan(*frames, kept, {}, {}));
    const TsdfOptions options{.voxel_size_mm = voxel_size_mm};
    const TsdfVolume volume = orExit(fuseScan(placed.archive, placed.trajectory, {}, options, {}));
    result.surface = removeSmallComponents(volume.extractSurface(2.0F), {.min_faces = 500});
    result.surface =
        orExit(refineSurface(std::move(result.surface), placed.archive, placed.trajectory, {}, {}));
  }
  const auto frames = orExit(openScanFolder(scan));
  while (auto frame = orExit(frames->next())) {
    const auto pose = poseAt(poses, frame->timestamp, kSameTime);
    if (!pose) {
      continue;
    }
    const double blur = blurMeasure(frame->color);
    auto& list = poseAt(kept, frame->timestamp, kSameTime) ? result.keyframes : result.left_out;
    list.push_back({.frame = std::move(*frame), .scan_from_camera = *pose, .blur = blur});
  }
  return result;
}

namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : bits_(seed) {}

  /// Even over the sphere: from points in the cube, those in the ball.
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d p(part(), part(), part());
      if (p.norm() <= 0.5 && p.norm() > 0.01) {
        return p.normalized();
      }
    }
  }

 private:
  double part() { return static_cast<double>(bits_()) / 4294967296.0 - 0.5; }

  std::mt19937 bits_;
};

/// What lies in the middle of the picture [mm, depth camera].
Eigen::Vector3d targetOf(const Keyframe& keyframe) {
  std::vector<float> depths;
  for (const float z : keyframe.frame.depth.pixels()) {
    if (z > 0.0F) {
      depths.push_back(z);
    }
  }
  if (depths.empty()) {
    return Eigen::Vector3d::Zero();
  }
  // The foot is nearer than the room: the nearest tenth is on it.
  const auto tenth = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 10);
  std::nth_element(depths.begin(), tenth, depths.end());
  return {0.0, 0.0, double{*tenth}};
}

}  // namespace

std::vector<Keyframe> withWrongPoses(std::vector<Keyframe> keyframes, const PoseError& error) {
  Dice dice(error.seed);
  for (Keyframe& keyframe : keyframes) {
    const Eigen::Vector3d pivot =
        error.about_target ? targetOf(keyframe) : Eigen::Vector3d::Zero().eval();
    const Eigen::Vector3d shift = error.shift_mm * dice.direction();
    const Eigen::AngleAxisd turn(error.turn_deg * std::numbers::pi / 180.0, dice.direction());
    RigidTransform motion = RigidTransform::Identity();
    motion.translate(pivot + shift).rotate(turn).translate(-pivot);
    keyframe.scan_from_camera = keyframe.scan_from_camera * motion;
  }
  return keyframes;
}

}  // namespace tarsus
