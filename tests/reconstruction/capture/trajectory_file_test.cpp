#include "reconstruction/capture/trajectory_file.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tarsus {
namespace {

using std::chrono::microseconds;

RigidTransform somePose(int i) {
  return Eigen::Translation3d(10.0 * i, -3.0, 400.0) *
         Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());
}

TEST(TrajectoryFile, RoundTripsTrackedPosesAndLeavesLostOnesOut) {
  const TemporaryFolder folder;
  Trajectory trajectory;
  for (int i = 0; i < 5; ++i) {
    FramePose pose{.frame_index = i, .timestamp = microseconds(33'333 * i)};
    if (i != 2) {
      pose.scan_from_camera = somePose(i);
    }
    trajectory.push_back(pose);
  }
  ASSERT_TRUE(writeTrajectory(folder.path() / "t.txt", trajectory));
  auto read = readTrajectory(folder.path() / "t.txt");
  ASSERT_TRUE(read) << describe(read.error());
  ASSERT_EQ(read->size(), 4U);
  EXPECT_EQ((*read)[2].timestamp, microseconds(99'999));
  // Nine decimals of a metre: a micrometre's thousandth.
  EXPECT_TRUE((*read)[2].scan_from_camera->isApprox(somePose(3), 1e-8));
}

TEST(TrajectoryFile, FindsThePoseNearestInTimeWithinTheTolerance) {
  const Trajectory trajectory{
      {.frame_index = 0, .timestamp = microseconds(0), .scan_from_camera = somePose(0)},
      {.frame_index = 1, .timestamp = microseconds(1000), .scan_from_camera = somePose(1)},
      {.frame_index = 2, .timestamp = microseconds(1100)}};
  const auto at = [&](int time_us) {
    return poseAt(trajectory, microseconds(time_us), microseconds(400));
  };
  ASSERT_TRUE(at(900));
  EXPECT_TRUE(at(900)->isApprox(somePose(1)));
  EXPECT_TRUE(at(1100)->isApprox(somePose(1)));  // the nearer one was lost
  EXPECT_TRUE(at(400)->isApprox(somePose(0)));
  EXPECT_FALSE(at(500));
}

TEST(TrajectoryFile, RefusesWhatIsNoTrajectory) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "t.txt";
  for (const char* text : {"",
                           "# only words\n",
                           "0 1 2 3 0 0 0\n",
                           "0 0 0 0 0 0 0 0\n",
                           "0 nan 0 0 0 0 0 1\n",
                           "zero 0 0 0 0 0 0 1\n"}) {
    std::ofstream(file) << text;
    auto read = readTrajectory(file);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::TrajectoryInvalid);
  }
  EXPECT_EQ(readTrajectory(folder.path() / "none.txt").error().code, ErrorCode::FileMissing);
}

}  // namespace
}  // namespace tarsus
