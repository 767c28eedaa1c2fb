#include "reconstruction/capture/simulator/camera_path.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

/// Longest step of the middle of the foot, seen from the camera, between frames [mm].
double longestStepMm(const SimulatorOptions& options) {
  const Eigen::Vector3d middle(130, 0, 30);
  double longest = 0.0;
  for (int i = 1; i < options.frames; ++i) {
    const RigidTransform before = roomFromCamera(options, frameTime(options, i - 1));
    const RigidTransform now = roomFromCamera(options, frameTime(options, i));
    longest = std::max(longest, (now.translation() - before.translation()).norm());
    const double distance_mm = (now.translation() - middle).norm();
    EXPECT_GT(distance_mm, 300.0);
    EXPECT_LT(distance_mm, 475.0);
  }
  return longest;
}

TEST(CameraPath, RigMovesSmoothlyOverTheSceneInTwentySeconds) {
  SimulatorOptions options;
  EXPECT_LT(longestStepMm(options), 9.0);  // 30 Hz
  EXPECT_GT(longestStepMm(options), 3.0);
  options.frames = 60;
  EXPECT_GT(longestStepMm(options), 30.0);  // the same motion, ten times coarser
}

TEST(CameraPath, LoopClosesAndQuickHurries) {
  SimulatorOptions options;
  options.path = CameraPath::Loop;
  EXPECT_LT((roomFromCamera(options, 0.0).inverse() * roomFromCamera(options, kMotionSeconds))
                .translation()
                .norm(),
            1e-6);
  options.path = CameraPath::Quick;
  EXPECT_GT(longestStepMm(options), 9.0);
}

TEST(CameraPath, RotationsAreProper) {
  for (const CameraPath path : {CameraPath::Rig, CameraPath::Loop, CameraPath::Quick}) {
    SimulatorOptions options;
    options.path = path;
    options.jitter_mm = 1.0;
    for (int i = 0; i < 40; ++i) {
      const Eigen::Matrix3d r = roomFromCamera(options, 0.5 * i).linear();
      EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
      EXPECT_GT(r.determinant(), 0.0);
    }
  }
}

TEST(CameraPath, JitterHasTheStandardDeviationAskedFor) {
  SimulatorOptions still;
  SimulatorOptions shaken;
  shaken.jitter_mm = 2.0;
  double sum2 = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    shaken.seed = seed;
    for (int i = 0; i < 600; ++i) {
      const double t = frameTime(still, i);
      const RigidTransform a = roomFromCamera(still, t);
      const RigidTransform b = roomFromCamera(shaken, t);
      sum2 += (b.translation() - a.translation()).squaredNorm() / 3.0;
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(sum2 / count), 2.0, 0.1);
}

}  // namespace
}  // namespace tarsus
