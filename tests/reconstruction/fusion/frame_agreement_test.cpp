#include "reconstruction/fusion/frame_agreement.h"

#include "reconstruction/fusion/fusion.h"
#include "tests/reconstruction/fusion/perturbed_scan.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

constexpr int kFrames = 12;
constexpr std::size_t kWrong = 7;

/// The surface that these frames make from their true poses.
TriangleMesh surfaceOf(const std::vector<RgbdFrame>& frames, const Trajectory& truth) {
  TsdfOptions options;
  options.voxel_size_mm = 2.0;
  options.with_color = false;
  return fuseScan(archiveOf(frames), truth, {}, options, {})->extractSurface(3.0F).mesh;
}

/// Moved 8 mm sideways, as a tracker may slip on a foot.
Trajectory withSlip(Trajectory trajectory, std::size_t i) {
  trajectory[i].scan_from_camera->pretranslate(Eigen::Vector3d(0.0, 8.0, 0.0));
  return trajectory;
}

TEST(FrameAgreement, RightPosesOfAnExactScanAgree) {
  const auto poses = arcPoses(kFrames, 0.03);
  const auto frames = framesOf(bumpyScene(), poses, Depth::Exact);
  const Trajectory truth = trajectoryOf(poses);
  const auto agreement = frameAgreement(surfaceOf(frames, truth), archiveOf(frames), truth);
  ASSERT_EQ(agreement.size(), poses.size());
  for (const FrameAgreement& frame : agreement) {
    EXPECT_GT(frame.readings, 3000);  // of about 10 000 vertices looked at
    EXPECT_EQ(frame.through_share, 0.0);
    EXPECT_GT(frame.agree_share, 0.99);  // but for the creases, which 2 mm voxels round off
  }
  EXPECT_TRUE(contradictingFrames(agreement).empty());
  EXPECT_EQ(medianThroughShare(agreement), 0.0);
}

TEST(FrameAgreement, NoiseAloneNamesNobody) {
  const auto poses = arcPoses(kFrames, 0.03);
  const auto frames = framesOf(bumpyScene(), poses, Depth::Noisy);
  const Trajectory truth = trajectoryOf(poses);
  const auto agreement = frameAgreement(surfaceOf(frames, truth), archiveOf(frames), truth);
  EXPECT_TRUE(contradictingFrames(agreement).empty());
  for (const FrameAgreement& frame : agreement) {
    EXPECT_LT(frame.through_share, 1e-3);  // 4 mm are ten standard deviations
    EXPECT_GT(frame.agree_share, 0.9);
  }
}

TEST(FrameAgreement, TheFrameThatSlippedIsNamedAndNoOther) {
  const auto poses = arcPoses(kFrames, 0.03);
  const Trajectory truth = trajectoryOf(poses);
  for (const Depth depth : {Depth::Exact, Depth::Noisy}) {
    const auto frames = framesOf(bumpyScene(), poses, depth);
    const Trajectory slipped = withSlip(truth, kWrong);
    // The wrong frame is in the surface, as in a true scan.
    const auto agreement = frameAgreement(surfaceOf(frames, slipped), archiveOf(frames), slipped);
    EXPECT_GT(agreement[kWrong].through_share, 0.02);
    EXPECT_EQ(contradictingFrames(agreement), std::vector{kWrong});
  }
}

TEST(FrameAgreement, SomethingBeforeTheSurfaceIsNoContradiction) {
  const auto poses = arcPoses(kFrames, 0.03);
  const Trajectory truth = trajectoryOf(poses);
  auto frames = framesOf(bumpyScene(), poses, Depth::Exact);
  const TriangleMesh surface = surfaceOf(frames, truth);
  AnalyticScene with_hand = bumpyScene();
  with_hand.spheres.push_back({{0, 0, 220}, 35});  // hides a sixth of the picture
  frames[kWrong] = frameOf(with_hand.render(smallCamera().depth, poses[kWrong]), kWrong);
  const auto agreement = frameAgreement(surface, archiveOf(frames), truth);
  EXPECT_LT(agreement[kWrong].agree_share, 0.95);  // it does hide something
  EXPECT_EQ(agreement[kWrong].through_share, 0.0);
  EXPECT_TRUE(contradictingFrames(agreement).empty());
}

TEST(FrameAgreement, ThroughMeansMoreThanFourMillimetresBehind) {
  const auto poses = arcPoses(4, 0.03);
  const auto frames = framesOf(bumpyScene(), poses, Depth::Exact);
  const Trajectory truth = trajectoryOf(poses);
  const TriangleMesh surface = surfaceOf(frames, truth);
  const auto pushedBack = [&](double mm) {
    Trajectory trajectory = truth;
    trajectory[1].scan_from_camera->pretranslate(Eigen::Vector3d(0.0, 0.0, mm));
    return frameAgreement(surface, archiveOf(frames), trajectory)[1];
  };
  EXPECT_EQ(pushedBack(3.0).through_share, 0.0);
  EXPECT_EQ(pushedBack(-6.0).through_share, 0.0);  // before the surface
  EXPECT_GT(pushedBack(6.0).through_share, 0.5);   // the wall, and what of the bumps faces it
  EXPECT_LT(pushedBack(3.0).agree_share, 0.2);     // 1.5 mm, and only steep sides move less
  EXPECT_GT(pushedBack(1.0).agree_share, 0.95);
}

TEST(FrameAgreement, FramesWithoutPoseSayNothing) {
  const auto poses = arcPoses(4, 0.03);
  const auto frames = framesOf(bumpyScene(), poses, Depth::Exact);
  Trajectory trajectory = trajectoryOf(poses);
  const TriangleMesh surface = surfaceOf(frames, trajectory);
  trajectory[2].scan_from_camera.reset();
  const auto agreement = frameAgreement(surface, archiveOf(frames), trajectory);
  EXPECT_EQ(agreement[2].readings, 0);
  EXPECT_EQ(agreement[2].agree_share, 0.0);
  EXPECT_EQ(agreement[2].through_share, 0.0);
  EXPECT_GT(agreement[1].readings, 0);
  EXPECT_TRUE(contradictingFrames(agreement).empty());
}

TEST(ContradictingFrames, CountsAgainstWhatTheWholeScanShows) {
  const auto with = [](std::vector<double> through) {
    std::vector<FrameAgreement> agreement;
    for (const double share : through) {
      agreement.push_back({.readings = 1000, .agree_share = 0.8, .through_share = share});
    }
    return agreement;
  };
  EXPECT_TRUE(contradictingFrames({}).empty());
  EXPECT_EQ(medianThroughShare({}), 0.0);
  EXPECT_EQ(contradictingFrames(with({0.0, 0.001, 0.02, 0.001, 0.0})), std::vector<std::size_t>{2});
  // Where all frames look through as often, it is the sensor's noise.
  EXPECT_TRUE(contradictingFrames(with({0.02, 0.025, 0.03, 0.02, 0.025})).empty());
  auto elsewhere = with({0.0, 0.0, 0.0});
  elsewhere[1].agree_share = 0.1;
  EXPECT_EQ(contradictingFrames(elsewhere), std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace tarsus
