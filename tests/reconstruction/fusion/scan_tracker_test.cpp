#include "reconstruction/fusion/scan_tracker.h"

#include "reconstruction/base/parallel.h"
#include "tests/reconstruction/fusion/analytic_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

/// A scan along the arc, at these angles [rad]; the first pose is the frame of reference.
std::vector<RgbdFrame> scanAt(const std::vector<double>& angles, bool noisy) {
  const RgbdCamera camera = smallCamera();
  const AnalyticScene scene = bumpyScene();
  std::vector<RgbdFrame> frames;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    DepthImage depth = scene.render(camera.depth, arcPose(angles[i]));
    frames.push_back(
        frameOf(noisy ? withNoise(depth, i + 1) : std::move(depth), static_cast<int>(i)));
  }
  return frames;
}

std::vector<double> arcOf(int count, double step_rad) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) {
    angles.push_back(step_rad * i);
  }
  return angles;
}

Expected<TrackedScan> trackFrames(std::vector<RgbdFrame> frames) {
  FrameList source(smallCamera(), std::move(frames));
  return trackScan(source, {}, {});
}

ScanArchive archiveOf(const std::vector<RgbdFrame>& frames) {
  ScanArchive archive(smallCamera(), static_cast<int>(frames.size()));
  for (const RgbdFrame& frame : frames) {
    archive.add(frame);
  }
  return archive;
}

double farthestCamera(const Trajectory& trajectory, const std::vector<double>& angles) {
  double farthest = 0.0;
  for (const FramePose& pose : trajectory) {
    if (pose.scan_from_camera) {
      const RigidTransform truth = arcPose(angles[static_cast<std::size_t>(pose.frame_index)]);
      farthest =
          std::max(farthest, (pose.scan_from_camera->translation() - truth.translation()).norm());
    }
  }
  return farthest;
}

TEST(TrackScan, FollowsAnExactScan) {
  const auto angles = arcOf(15, 0.02);  // 8 mm a frame
  const auto result = trackFrames(scanAt(angles, false));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->frames_tracked, 15);
  EXPECT_EQ(static_cast<int>(result->trajectory.size()) - result->frames_tracked, 0);
  EXPECT_EQ(result->relocalisations, 0);
  EXPECT_EQ(result->trajectory.front().scan_from_camera->matrix(), Eigen::Matrix4d::Identity());
  // 2 mm voxels round off the creases between bumps and wall.
  EXPECT_LT(farthestCamera(result->trajectory, angles), 0.5);
  EXPECT_LT(result->rmse_mm, 0.5);
}

TEST(TrackScan, FollowsANoisyScan) {
  const auto angles = arcOf(15, 0.02);
  const auto result = trackFrames(scanAt(angles, true));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->frames_tracked, 15);
  // The limit for a simulated scan as root mean square is 0.6 mm.
  EXPECT_LT(farthestCamera(result->trajectory, angles), 0.6);
  EXPECT_LT(result->rmse_mm, 1.2);  // the prototype's "good"
}

TEST(TrackScan, FollowsStepsOfTwentyMillimetres) {
  std::vector<double> angles;
  for (int i = 0; i < 10; ++i) {
    angles.push_back(i % 2 == 0 ? 0.0 : 0.05);  // to and fro: the prediction is always wrong
  }
  const auto result = trackFrames(scanAt(angles, true));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->frames_tracked, 10);
  // With a single other frame to hold on to: 0.14 degrees seen from the bumps.
  EXPECT_LT(farthestCamera(result->trajectory, angles), 1.0);
}

TEST(TrackScan, BlackFramesAreLostAndTheScanGoesOn) {
  const auto angles = arcOf(12, 0.01);
  auto frames = scanAt(angles, true);
  for (int i = 4; i < 7; ++i) {
    frames[static_cast<std::size_t>(i)] = frameOf(DepthImage(320, 240), i);
  }
  const auto result = trackFrames(std::move(frames));
  ASSERT_TRUE(result);
  EXPECT_EQ(static_cast<int>(result->trajectory.size()) - result->frames_tracked, 3);
  EXPECT_EQ(result->relocalisations, 1);
  for (int i = 4; i < 7; ++i) {
    EXPECT_FALSE(result->trajectory[static_cast<std::size_t>(i)].scan_from_camera);
  }
  EXPECT_LT(farthestCamera(result->trajectory, angles), 0.6);
}

TEST(TrackScan, FirstFrameMayBeBlack) {
  const auto angles = arcOf(8, 0.0);
  auto frames = scanAt(angles, true);
  frames[0] = frameOf(DepthImage(320, 240), 0);
  const auto result = trackFrames(std::move(frames));
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->trajectory[0].scan_from_camera);
  EXPECT_EQ(result->trajectory[1].scan_from_camera->matrix(), Eigen::Matrix4d::Identity());
}

TEST(ScanTracker, AnotherSceneIsLostNeverFusedAndLeftAgain) {
  const auto angles = arcOf(10, 0.01);
  const auto frames = scanAt(angles, true);
  AnalyticScene other;
  other.spheres = {{{30, 10, 330}, 25}, {{-70, 50, 380}, 60}};
  other.planes = {{Eigen::Vector3d(-0.5, -0.3, 1.0).normalized(), 360.0}};
  const RgbdCamera camera = smallCamera();
  ScanTracker tracker(camera, {});
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(tracker.push(frames[i]).scan_from_camera);
  }
  const ExtractedSurface before = tracker.model().extractSurface(1.0F);
  for (int i = 0; i < 3; ++i) {
    const FramePose pose = tracker.push(
        frameOf(withNoise(other.render(camera.depth, RigidTransform::Identity()), 99), 100 + i));
    EXPECT_FALSE(pose.scan_from_camera);
  }
  const ExtractedSurface after = tracker.model().extractSurface(1.0F);
  EXPECT_TRUE(before.mesh.vertices == after.mesh.vertices);
  EXPECT_TRUE(before.sigma_mm == after.sigma_mm);
  const FramePose back = tracker.push(frames[5]);
  ASSERT_TRUE(back.scan_from_camera);
  EXPECT_EQ(tracker.relocalisations(), 1);
  EXPECT_LT((back.scan_from_camera->translation() - arcPose(angles[5]).translation()).norm(), 0.6);
}

TEST(ScanTracker, FindsItselfAgainFarBackOnThePath) {
  const auto angles = arcOf(25, 0.03);  // 0.72 rad, 290 mm
  const auto frames = scanAt(angles, true);
  ScanTracker tracker(smallCamera(), {});
  for (const RgbdFrame& frame : frames) {
    ASSERT_TRUE(tracker.push(frame).scan_from_camera);
  }
  EXPECT_FALSE(tracker.push(frameOf(DepthImage(320, 240), 100)).scan_from_camera);
  const FramePose back = tracker.push(frames[2]);
  ASSERT_TRUE(back.scan_from_camera);
  EXPECT_LT((back.scan_from_camera->translation() - arcPose(angles[2]).translation()).norm(), 0.8);
}

TEST(TrackScan, BareWallIsNotFollowed) {
  // Along a wall the camera may slide and turn unseen: three directions are free.
  AnalyticScene wall;
  wall.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  std::vector<RgbdFrame> frames;
  for (int i = 0; i < 6; ++i) {
    frames.push_back(frameOf(wall.render(smallCamera().depth, RigidTransform::Identity()), i));
  }
  const auto result = trackFrames(std::move(frames));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::TrackingLost);
}

TEST(TrackScan, EmptyAndBlackScansAreRefused) {
  EXPECT_EQ(trackFrames({}).error().code, ErrorCode::ScanEmpty);
  std::vector<RgbdFrame> black;
  for (int i = 0; i < 4; ++i) {
    black.push_back(frameOf(DepthImage(320, 240), i));
  }
  EXPECT_EQ(trackFrames(std::move(black)).error().code, ErrorCode::TrackingLost);
}

TEST(TrackScan, StopsWhenAsked) {
  std::stop_source stop;
  int reports = 0;
  Job job;
  job.stop = stop.get_token();
  job.report = [&](std::string_view, double) {
    if (++reports == 2) {
      stop.request_stop();
    }
  };
  FrameList source(smallCamera(), scanAt(arcOf(5, 0.01), false));
  const auto result = trackScan(source, {}, job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(reports, 2);
}

TEST(TrackScan, SameBitsWithOneThreadAndTwo) {
  const auto angles = arcOf(5, 0.02);
  const auto tracked = [&](int threads) {
    const ThreadLimit limit(threads);
    return trackFrames(scanAt(angles, true));
  };
  const auto one = tracked(1);
  const auto two = tracked(2);
  ASSERT_TRUE(one && two);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    EXPECT_EQ(one->trajectory[i].scan_from_camera->matrix(),
              two->trajectory[i].scan_from_camera->matrix());
    EXPECT_EQ(one->trajectory[i].rmse_mm, two->trajectory[i].rmse_mm);
  }
}

TEST(FuseScan, FusesOnlyFramesWithAPose) {
  const auto angles = arcOf(6, 0.02);
  Trajectory trajectory;
  for (int i = 0; i < 6; ++i) {
    FramePose pose;
    pose.timestamp = frameOf({}, i).timestamp;
    if (i != 3) {
      pose.scan_from_camera = arcPose(angles[static_cast<std::size_t>(i)]);
    }
    trajectory.push_back(pose);
  }
  auto frames = scanAt(angles, false);
  frames[3] = frameOf(scanAt({1.0}, false).front().depth, 3);  // must not be looked at
  TsdfOptions options;
  options.with_color = false;
  const auto fused = fuseScan(archiveOf(frames), trajectory, {}, options, {});
  ASSERT_TRUE(fused);
  const AnalyticScene scene = bumpyScene();
  double squares = 0.0;
  const ExtractedSurface surface = fused->extractSurface(3.0F);
  for (const Eigen::Vector3f& vertex : surface.mesh.vertices) {
    squares += std::pow(scene.distance(vertex.cast<double>()), 2);
  }
  EXPECT_GT(surface.mesh.vertices.size(), 10000U);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(surface.mesh.vertices.size())), 0.1);
}

TEST(FuseScan, NoPoseForAnyFrameIsRefused) {
  const auto volume = fuseScan(archiveOf(scanAt({0.0}, false)), Trajectory(1), {}, {}, {});
  ASSERT_FALSE(volume);
  EXPECT_EQ(volume.error().code, ErrorCode::ScanEmpty);
}

}  // namespace
}  // namespace tarsus
