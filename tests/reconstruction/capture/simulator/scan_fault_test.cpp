// What each fault does to the frames, and that it does nothing else.
#include "reconstruction/capture/simulator/scan_fault.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/parallel.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace tarsus {
namespace {

constexpr std::array kFaults{ScanFault::Black,
                             ScanFault::Jump,
                             ScanFault::Holes,
                             ScanFault::Dropped,
                             ScanFault::Mirrored,
                             ScanFault::Rest,
                             ScanFault::Blocked,
                             ScanFault::Unit};

constexpr int kFrames = 60;  ///< of the scenes that are built; few of them are looked at

SimulatorOptions with(ScanFault fault, int frames = kFrames) {
  SimulatorOptions options;
  options.fault = fault;
  options.frames = frames;
  return options;
}

using Scene = std::shared_ptr<const SimulatedScene>;

/// Built once; only the path of the camera depends on the fault.
Scene soundScene() {
  static const Scene scene = *buildScene(with(ScanFault::None));
  return scene;
}

Scene jumpingScene() {
  static const Scene scene = *buildScene(with(ScanFault::Jump));
  return scene;
}
Scene restingScene() {
  static const Scene scene = *buildScene(with(ScanFault::Rest, 3));
  return scene;
}

/// The same foot with the first `count` poses: rendering is what these tests spend their time on.
Scene sceneOf(int count) {
  auto scene = std::make_shared<SimulatedScene>(*soundScene());
  scene->trajectory.resize(static_cast<std::size_t>(count));
  return scene;
}

std::vector<RgbdFrame> framesOf(FrameSource& source) {
  std::vector<RgbdFrame> frames;
  for (;;) {
    auto frame = source.next();
    EXPECT_TRUE(frame);
    if (!frame || !*frame) {
      return frames;
    }
    frames.push_back(std::move(**frame));
  }
}

std::vector<RgbdFrame> framesOf(ScanFault fault, int count, const Scene& scene) {
  return framesOf(*openSimulator(scene, with(fault, count)));
}
std::vector<RgbdFrame> framesOf(ScanFault fault, int count) {
  return framesOf(fault, count, sceneOf(count));
}

/// Three frames without a fault, rendered once.
const std::vector<RgbdFrame>& soundFrames() {
  static const std::vector<RgbdFrame> frames = framesOf(ScanFault::None, 3);
  return frames;
}

bool sameDepth(const DepthImage& a, const DepthImage& b) {
  return std::ranges::equal(a.pixels(), b.pixels());
}
bool sameColor(const ColorImage& a, const ColorImage& b) {
  return a.pixels().size() == b.pixels().size() &&
         std::memcmp(a.pixels().data(), b.pixels().data(), a.pixels().size_bytes()) == 0;
}
bool same(const RgbdFrame& a, const RgbdFrame& b) {
  return sameDepth(a.depth, b.depth) && sameColor(a.color, b.color);
}

TEST(ScanFaultBlack, FifteenFramesInTheMiddleShowNothing) {
  const auto frames = framesOf(ScanFault::Black, 18);
  ASSERT_EQ(frames.size(), 18U);
  int black = 0;
  for (const RgbdFrame& frame : frames) {
    EXPECT_EQ(frame.depth.pixels().size(), 640U * 480U);
    const bool no_depth =
        std::ranges::all_of(frame.depth.pixels(), [](float z_mm) { return z_mm == 0.0F; });
    const bool no_color = std::ranges::all_of(frame.color.pixels(),
                                              [](const Rgb8& c) { return c.r + c.g + c.b == 0; });
    EXPECT_EQ(no_depth, no_color) << frame.index;
    black += no_depth ? 1 : 0;
    EXPECT_EQ(no_depth, strikes(ScanFault::Black, frame.index, 18)) << frame.index;
  }
  EXPECT_EQ(black, 15);
  EXPECT_TRUE(sameDepth(frames.front().depth, soundFrames().front().depth));
}

TEST(ScanFaultJump, PushesTheRestOfThePathAsideThreeTimes) {
  const Trajectory& sound = soundScene()->trajectory;
  const Trajectory& pushed = jumpingScene()->trajectory;
  ASSERT_EQ(pushed.size(), sound.size());
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const RigidTransform& a = *sound[i].scan_from_camera;
    const RigidTransform& b = *pushed[i].scan_from_camera;
    EXPECT_TRUE(a.linear() == b.linear()) << i;
    const Eigen::Vector3d aside = b.translation() - a.translation();
    const bool jumps = i == 15 || i == 30 || i == 45;
    const Eigen::Vector3d step =
        jumps ? Eigen::Vector3d(20.0 * a.linear().col(0)) : Eigen::Vector3d(0.0, 0.0, 0.0);
    // Rounding of sums below a metre.
    EXPECT_LT((aside - before - step).norm(), 1e-9) << i;
    before = aside;
  }
}

/// Median over the wound's rim of how far the picture's depth is from what the pose foretells.
double rimErrorMm(const RgbdFrame& frame,
                  const Intrinsics& camera,
                  const RigidTransform& scan_from_camera) {
  std::vector<double> errors_mm;
  for (const Eigen::Vector3d& p : soundScene()->wounds[0].outline_mm) {
    const Eigen::Vector3d p_camera = scan_from_camera.inverse() * p;
    const Eigen::Vector2d px = camera.project(p_camera);
    errors_mm.push_back(std::abs(double{frame.depth.at(static_cast<int>(std::lround(px.x())),
                                                       static_cast<int>(std::lround(px.y())))} -
                                 p_camera.z()));
  }
  std::ranges::sort(errors_mm);
  return errors_mm[errors_mm.size() / 2];
}

TEST(ScanFaultJump, TheCameraSeesTheFootFromWhereItWasPushed) {
  auto scene = std::make_shared<SimulatedScene>(*jumpingScene());
  scene->trajectory = {scene->trajectory[14], scene->trajectory[15]};
  SimulatorOptions options = with(ScanFault::Jump, kFrames);
  options.noise = 0.0;
  const auto source = openSimulator(scene, options);
  const auto frames = framesOf(*source);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    // A pixel is 0.7 mm wide there and the rim is steep.
    EXPECT_LT(rimErrorMm(frames[i], source->camera().depth, *scene->trajectory[i].scan_from_camera),
              0.5);
  }
  const RigidTransform& not_pushed = *soundScene()->trajectory[15].scan_from_camera;
  EXPECT_GT(rimErrorMm(frames[1], source->camera().depth, not_pushed), 1.5);
}

TEST(ScanFaultHoles, TakeThirtyPercentInPatchesThatDifferFromFrameToFrame) {
  const auto holed = framesOf(ScanFault::Holes, 2);
  const auto& sound = soundFrames();
  std::array<Image<std::uint8_t>, 2> gone{Image<std::uint8_t>(640, 480),
                                          Image<std::uint8_t>(640, 480)};
  for (std::size_t i = 0; i < 2; ++i) {
    int measured = 0;
    int lost = 0;
    for (std::size_t k = 0; k < sound[i].depth.pixels().size(); ++k) {
      const float before = sound[i].depth.pixels()[k];
      const float after = holed[i].depth.pixels()[k];
      ASSERT_TRUE(after == before || after == 0.0F);
      measured += before > 0.0F ? 1 : 0;
      lost += before > 0.0F && after == 0.0F ? 1 : 0;
      gone[i].pixels()[k] = after == 0.0F && before > 0.0F ? 1 : 0;
    }
    // 30 % of the image; the measured part holds some 2000 patches of it: a share of 0.46 / 45.
    EXPECT_NEAR(static_cast<double>(lost) / measured, 0.3, 0.02);
    EXPECT_TRUE(sameColor(holed[i].color, sound[i].color));
  }
  int both = 0;
  int first = 0;
  for (std::size_t k = 0; k < gone[0].pixels().size(); ++k) {
    both += gone[0].pixels()[k] * gone[1].pixels()[k];
    first += gone[0].pixels()[k];
  }
  // Independent patches meet in 30 % of their pixels; the same patches would meet in all.
  EXPECT_LT(both, 0.4 * first);
}

TEST(ScanFaultHoles, ArePatchesOfThreeToTwelvePixels) {
  DepthImage full(640, 480);
  std::ranges::fill(full.pixels(), 400.0F);
  const DepthImage holed = withHoles(full, 1, 0);
  const auto lost = std::ranges::count(holed.pixels(), 0.0F);
  EXPECT_NEAR(static_cast<double>(lost) / (640.0 * 480.0), 0.3, 0.001);
  // Single pixels would leave 0.7^2 x 0.3 of all pixels as a lost one between two kept ones;
  // patches of 3 px and more have that at their tips alone.
  int lonely = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 1; u < 639; ++u) {
      lonely += holed.at(u, v) == 0.0F && holed.at(u - 1, v) > 0.0F && holed.at(u + 1, v) > 0.0F;
    }
  }
  EXPECT_LT(static_cast<double>(lonely), 0.05 * static_cast<double>(lost));
  EXPECT_FALSE(sameDepth(holed, withHoles(full, 2, 0)));
}

TEST(ScanFaultDropped, EverySecondFrameIsMissingAndTheTimesStay) {
  const auto kept = framesOf(ScanFault::Dropped, 3);
  const auto& sound = soundFrames();
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(openSimulator(sceneOf(5), with(ScanFault::Dropped, 5))->frameCount(), 3);
  EXPECT_EQ(openSimulator(sceneOf(4), with(ScanFault::Dropped, 4))->frameCount(), 2);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].index, static_cast<int>(i));
    EXPECT_EQ(kept[i].timestamp, sound[2 * i].timestamp);
    EXPECT_TRUE(same(kept[i], sound[2 * i])) << i;
  }
}

TEST(ScanFaultMirrored, ExchangesLeftAndRightOfTheColourInTheSecondHalf) {
  const auto frames = framesOf(ScanFault::Mirrored, 3);
  const auto& sound = soundFrames();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(same(frames[0], sound[0]));
  EXPECT_TRUE(same(frames[1], sound[1]));
  EXPECT_TRUE(sameDepth(frames[2].depth, sound[2].depth));
  for (int v = 0; v < 480; v += 7) {
    for (int u = 0; u < 640; ++u) {
      const Rgb8& a = frames[2].color.at(u, v);
      const Rgb8& b = sound[2].color.at(639 - u, v);
      ASSERT_TRUE(a.r == b.r && a.g == b.g && a.b == b.b) << u << ' ' << v;
    }
  }
}

TEST(ScanFaultRest, OnlyTheNoiseDiffers) {
  const Scene resting = restingScene();
  ASSERT_EQ(resting->trajectory.size(), 3U);
  for (const FramePose& pose : resting->trajectory) {
    EXPECT_TRUE(pose.scan_from_camera->matrix() == Eigen::Matrix4d::Identity());
  }
  const auto noisy = framesOf(ScanFault::Rest, 3, resting);
  EXPECT_FALSE(sameDepth(noisy[1].depth, noisy[2].depth));
  SimulatorOptions clean = with(ScanFault::Rest, 3);
  clean.noise = 0.0;
  const auto exact = framesOf(*openSimulator(resting, clean));
  EXPECT_TRUE(same(exact[0], exact[2]));
}

TEST(ScanFaultBlocked, AHandIsAllThereIsForOneSecond) {
  int blocked = 0;
  for (int i = 0; i < 600; ++i) {
    blocked += strikes(ScanFault::Blocked, i, 600) ? 1 : 0;
  }
  EXPECT_EQ(blocked, 30);
  const auto frames = framesOf(ScanFault::Blocked, 3);
  const auto& sound = soundFrames();
  EXPECT_TRUE(same(frames[0], sound[0]));
  EXPECT_TRUE(same(frames[2], sound[2]));
  double sum_mm = 0.0;
  for (const float z_mm : frames[1].depth.pixels()) {
    // sigma_z at 150 mm is 0.24 mm, 0.36 mm in the corners; noise ends at 3.5 of them at the most.
    ASSERT_NEAR(z_mm, 150.0, 2.0);
    sum_mm += double{z_mm};
  }
  EXPECT_NEAR(sum_mm / (640.0 * 480.0), 150.0, 0.01);
  EXPECT_GT(frames[1].color.at(320, 240).r, frames[1].color.at(320, 240).b);
}

TEST(ScanFaultUnit, EverythingIsEightTimesTooFarAndTheFilesHoldTheSameNumbers) {
  const auto source = openSimulator(sceneOf(1), with(ScanFault::Unit, 1));
  EXPECT_EQ(source->camera().depth_units_per_m, 1000.0);
  const auto wrong = framesOf(*source);
  const auto& sound = soundFrames();
  for (std::size_t k = 0; k < sound[0].depth.pixels().size(); ++k) {
    ASSERT_EQ(wrong[0].depth.pixels()[k], 8.0F * sound[0].depth.pixels()[k]);
  }
  const TemporaryFolder folder;
  ASSERT_TRUE(writeSimulatedScan(folder.path(), sceneOf(1), with(ScanFault::Unit, 1), Job{}));
  EXPECT_EQ(readCamera(folder.path() / "camera.json")->depth_units_per_m, 1000.0);
  const auto stored = readDepthImage(folder.path() / "depth" / "0.000000.png", 8000.0);
  ASSERT_TRUE(stored);
  EXPECT_TRUE(sameDepth(*stored, sound[0].depth));
  // The reader notices; with the right unit given by hand, the scan is sound.
  const auto refused = openScanFolder(folder.path());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::DepthUnitImplausible);
  EXPECT_TRUE(openScanFolder(folder.path(), {.intrinsics = {}, .depth_units_per_m = 8000.0}));
}

TEST(ScanFaults, GiveTheSameBitsForAnyNumberOfThreads) {
  const auto together = framesOf(ScanFault::Holes, 1);
  const ThreadLimit one_thread(1);
  const auto alone = framesOf(ScanFault::Holes, 1);
  EXPECT_TRUE(same(alone[0], together[0]));
}

TEST(ScanFaults, TruthFilesHoldTheFramesThereAndNameTheFault) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeSimulatedScan(folder.path(), sceneOf(3), with(ScanFault::Dropped, 3), Job{}));
  auto scan = openScanFolder(folder.path());
  ASSERT_TRUE(scan) << describe(scan.error());
  const auto frames = framesOf(**scan);
  EXPECT_TRUE((*scan)->warnings().empty());
  const auto truth = readTrajectory(folder.path() / "groundtruth.txt");
  ASSERT_TRUE(truth);
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_EQ(truth->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*truth)[i].timestamp, frames[i].timestamp);
    // Written with a finite number of digits.
    EXPECT_LT(((*truth)[i].scan_from_camera->translation() -
               soundScene()->trajectory[2 * i].scan_from_camera->translation())
                  .norm(),
              1e-3);
  }
  const auto facts = nlohmann::json::parse(*readTextFile(folder.path() / "truth" / "truth.json"));
  EXPECT_EQ(facts["options"]["fault"], "dropped");
}

TEST(ScanFaults, LeaveFootAndWoundAsTheyAre) {
  for (const Scene& scene : {jumpingScene(), restingScene()}) {
    EXPECT_EQ(scene->foot.mesh.vertices, soundScene()->foot.mesh.vertices);
    EXPECT_EQ(scene->wounds[0].volume_mm3, soundScene()->wounds[0].volume_mm3);
  }
}

TEST(ScanFaults, NamesReadBackAsTheyArePrinted) {
  for (const ScanFault fault : kFaults) {
    EXPECT_EQ(scanFaultNamed(nameOf(fault)), fault);
  }
  EXPECT_EQ(scanFaultNamed("none"), ScanFault::None);
  EXPECT_FALSE(scanFaultNamed("Black"));
  EXPECT_FALSE(scanFaultNamed(""));
}

TEST(ScanFaults, AlwaysSpareTheFirstFrame) {
  for (const ScanFault fault :
       {ScanFault::Black, ScanFault::Dropped, ScanFault::Mirrored, ScanFault::Blocked}) {
    for (int frames = 1; frames < 40; ++frames) {
      EXPECT_FALSE(strikes(fault, 0, frames)) << nameOf(fault) << ' ' << frames;
    }
  }
  EXPECT_TRUE(strikes(ScanFault::Black, 300, 600));
}

}  // namespace
}  // namespace tarsus
