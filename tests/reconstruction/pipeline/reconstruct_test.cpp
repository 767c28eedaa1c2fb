// The whole way from frames to model, on a simulated foot whose truth is known.
#include "reconstruction/pipeline/reconstruct.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/pipeline/model_folder.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/ply.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace tarsus {
namespace {

/// Frames that were rendered beforehand.
class FramesInMemory final : public FrameSource {
 public:
  FramesInMemory(const RgbdCamera& camera, const std::vector<RgbdFrame>& frames)
      : camera_(camera), frames_(frames) {}
  [[nodiscard]] const RgbdCamera& camera() const override { return camera_; }
  [[nodiscard]] std::optional<int> frameCount() const override {
    return static_cast<int>(frames_.size());
  }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    return next_ < frames_.size() ? std::optional(frames_[next_++]) : std::nullopt;
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

 private:
  const RgbdCamera& camera_;
  const std::vector<RgbdFrame>& frames_;
  std::size_t next_ = 0;
  Warnings warnings_;
};

constexpr int kFrames = 80;  // of 600: a true scan's steps, but only the first stretch of the path

/// One simulated foot and its frames for all tests here: they take seconds to make.
class ReconstructScan : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const SimulatorOptions simulation;
    auto scene = buildScene(simulation);
    ASSERT_TRUE(scene) << describe(scene.error());
    scene_ = *scene;
    const auto source = openSimulator(scene_, simulation);
    camera_ = source->camera();
    for (int i = 0; i < kFrames; ++i) {
      auto frame = source->next();
      ASSERT_TRUE(frame && *frame);
      frames_.push_back(std::move(**frame));
    }
  }
  static void TearDownTestSuite() {
    scene_.reset();
    frames_.clear();
  }

  static ScanOpener opener() {
    return [](const FrameContent&) { return std::make_unique<FramesInMemory>(camera_, frames_); };
  }

  static inline std::shared_ptr<const SimulatedScene> scene_;
  static inline RgbdCamera camera_;
  static inline std::vector<RgbdFrame> frames_;
};

/// Root mean square distance of camera positions to the truth (design.md section 5).
double trajectoryRmse(const Trajectory& estimated, const Trajectory& truth) {
  double sum = 0.0;
  int count = 0;
  for (const FramePose& pose : estimated) {
    const auto expected = poseAt(truth, pose.timestamp, std::chrono::microseconds(1000));
    if (pose.scan_from_camera && expected) {
      sum += (pose.scan_from_camera->translation() - expected->translation()).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(sum / std::max(1, count));
}

/// Distances of the model's vertices to the true foot, sorted [mm].
std::vector<double> distancesToFoot(const TriangleMesh& model, const TriangleMesh& foot) {
  const MeshIndex index(foot);
  std::vector<double> distances;
  for (const Eigen::Vector3f& v : model.vertices) {
    const auto nearest = index.nearest(v.cast<double>(), 1000.0);
    distances.push_back(nearest ? nearest->distance_mm : 1000.0);
  }
  std::ranges::sort(distances);
  return distances;
}

TEST_F(ReconstructScan, FindsTheFootAndOnlyTheFoot) {
  ScanOptions options;
  options.texture = false;
  auto result = reconstructScan(opener(), options, {});
  ASSERT_TRUE(result) << describe(result.error());
  EXPECT_EQ(result->frames_tracked, kFrames);
  EXPECT_TRUE(result->fitForMeasurement());
  EXPECT_LE(trajectoryRmse(result->trajectory, scene_->trajectory), 0.6);  // of a whole scan
  const auto distances = distancesToFoot(result->model.mesh, scene_->foot.mesh);
  EXPECT_LE(distances[distances.size() * 95 / 100], 1.0);
  EXPECT_LE(distances.back(), 5.0);  // no piece of bench or wall, no flying shell
  EXPECT_TRUE(result->trajectory.front().scan_from_camera->isApprox(RigidTransform::Identity()));
}

TEST_F(ReconstructScan, WithTheBackgroundKeptThereIsMore) {
  ScanOptions options;
  options.texture = false;
  options.keep_background = true;
  options.trajectory = scene_->trajectory;
  auto result = reconstructScan(opener(), options, {});
  ASSERT_TRUE(result) << describe(result.error());
  EXPECT_GE(distancesToFoot(result->model.mesh, scene_->foot.mesh).back(), 50.0);
  EXPECT_FALSE(result->tracking_rmse_mm);
  EXPECT_LE(trajectoryRmse(result->trajectory, scene_->trajectory), 1e-9);
}

/// Poses as a bad rig would state them: each off on its own by up to 5 mm and a degree about the
/// scene's middle, but for the first, which is the frame of reference.
Trajectory offByFiveMillimetres(Trajectory trajectory) {
  std::mt19937 dice(23);
  const auto roll = [&] { return static_cast<double>(dice()) * 0x1.0p-31 - 1.0; };
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double x = roll();
    const double y = roll();
    const Eigen::Vector3d direction = Eigen::Vector3d(x, y, roll()).normalized();
    const double size = roll();
    RigidTransform& pose = *trajectory[i].scan_from_camera;
    const Eigen::Vector3d middle = pose * Eigen::Vector3d(0.0, 0.0, 400.0);
    pose = Eigen::Translation3d(middle + 5.0 * size * direction) *
           Eigen::AngleAxisd(size * std::numbers::pi / 180.0,
                             direction.cross(Eigen::Vector3d::UnitX()).normalized()) *
           Eigen::Translation3d(-middle) * pose;
  }
  return trajectory;
}

TEST_F(ReconstructScan, KnownPosesStayUnlessTheyMayBeRefined) {
  ScanOptions options;
  options.texture = false;
  options.trajectory = offByFiveMillimetres(scene_->trajectory);
  const auto stated = reconstructScan(opener(), options, {});
  ASSERT_TRUE(stated) << describe(stated.error());
  options.refine_trajectory = true;
  const auto refined = reconstructScan(opener(), options, {});
  ASSERT_TRUE(refined) << describe(refined.error());
  ASSERT_EQ(stated->trajectory.size(), std::size_t{kFrames});
  for (std::size_t i = 0; i < kFrames; ++i) {
    if (stated->trajectory[i].scan_from_camera) {  // frames may be left out
      EXPECT_LE((stated->trajectory[i].scan_from_camera->matrix() -
                 (*options.trajectory)[i].scan_from_camera->matrix())
                    .norm(),
                1e-9);
    }
  }
  EXPECT_GE(trajectoryRmse(*options.trajectory, scene_->trajectory), 2.0);
  EXPECT_LE(trajectoryRmse(refined->trajectory, scene_->trajectory), 1.0);
  EXPECT_EQ(refined->frames_tracked, kFrames);
}

TEST_F(ReconstructScan, SameScanSameBitsWhateverTheThreads) {
  ScanOptions options;
  std::optional<ThreadLimit> alone(1);
  auto once = reconstructScan(opener(), options, {});
  alone.reset();
  auto again = reconstructScan(opener(), options, {});
  ASSERT_TRUE(once && again);
  EXPECT_EQ(once->model.sha256, again->model.sha256);
  EXPECT_EQ(once->scan_sha256, again->scan_sha256);
  EXPECT_EQ(once->model.mesh.normals, again->model.mesh.normals);
  EXPECT_EQ(once->model.sigma_mm, again->model.sigma_mm);
}

TEST_F(ReconstructScan, TheTextureShowsTheFootAndTheFolderIsWhole) {
  const TemporaryFolder folder;
  const ScanOptions options;
  auto result = reconstructScan(opener(), options, {});
  ASSERT_TRUE(result) << describe(result.error());
  ASSERT_TRUE(result->photometric_rmse_before && result->photometric_rmse_after);
  EXPECT_LT(*result->photometric_rmse_after, *result->photometric_rmse_before);
  EXPECT_LT(result->unseen_fraction, 0.3);
  ASSERT_TRUE(writeModelFolder(folder.path(), *result, options, "1.2.3"));

  auto model = readPly(folder.path() / "model.ply");
  ASSERT_TRUE(model) << describe(model.error());
  EXPECT_EQ(model->sha256, result->model.sha256);
  EXPECT_EQ(model->unseen, result->model.unseen);
  EXPECT_NE(std::ranges::find(model->comments, "fit_for_measurement yes"), model->comments.end());
  auto trajectory = readTrajectory(folder.path() / "trajectory.txt");
  ASSERT_TRUE(trajectory);
  EXPECT_EQ(trajectory->size(), std::size_t{kFrames});
  auto keyframes = openScanFolder(folder.path() / "keyframes");
  ASSERT_TRUE(keyframes) << describe(keyframes.error());
  EXPECT_EQ((*keyframes)->frameCount(), static_cast<int>(result->keyframes.size()));

  EXPECT_TRUE(std::filesystem::exists(folder.path() / "keyframes" / "contact.png"));

  const nlohmann::json json = toJson(*result, options, "1.2.3");
  const auto& choice = json.at("keyframe_choice");
  EXPECT_EQ(choice.at("frames").size(), result->keyframes.size());
  EXPECT_GE(choice.at("vertices_covered").get<int>(),
            choice.at("vertices_coverable").get<int>() * 95 / 100);
  EXPECT_TRUE(json.at("color_card").is_null());
  for (const char* key : {"frames_total",
                          "frames_tracked",
                          "frames_lost",
                          "relocalisations",
                          "tracking_rmse_mm",
                          "loop_residual_mm",
                          "vertices",
                          "faces",
                          "unseen_fraction",
                          "keyframes",
                          "photometric_rmse_before",
                          "photometric_rmse_after",
                          "stages",
                          "peak_memory_mb",
                          "origin_timestamp",
                          "fit_for_measurement",
                          "refusal_reasons",
                          "options",
                          "version",
                          "warnings"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

TEST_F(ReconstructScan, StopsWhenAsked) {
  std::stop_source stop;
  int reports = 0;
  const Job job{.stop = stop.get_token(), .report = [&](std::string_view, double) {
                  if (++reports == 5) {
                    stop.request_stop();
                  }
                }};
  auto result = reconstructScan(opener(), {}, job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::Cancelled);
}

TEST_F(ReconstructScan, PosesOfAnotherScanAreRefused) {
  ScanOptions options;
  options.trajectory = Trajectory{{.frame_index = 0,
                                   .timestamp = std::chrono::hours(1),
                                   .scan_from_camera = RigidTransform::Identity()}};
  auto result = reconstructScan(opener(), options, {});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::TrajectoryInvalid);
}

}  // namespace
}  // namespace tarsus
