#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/fusion/fusion.h"
#include "tests/support/shared_data.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

TEST(RealScans, TabletopIsTrackedWithinFifteenMillimetres) {
  const auto folder = sharedData("tabletop");
  if (!folder) {
    GTEST_SKIP() << "needs the shared data set tabletop";
  }
  const auto frames = openScanFolder(*folder, {}, {.color = false});
  ASSERT_TRUE(frames);
  const auto reference = readTrajectory(*folder / "groundtruth.txt");
  ASSERT_TRUE(reference);
  const auto result = trackScan(**frames, {}, {});
  ASSERT_TRUE(result);
  EXPECT_GE(result->frames_tracked, 48);
  const auto first =
      poseAt(*reference, result->trajectory.front().timestamp, std::chrono::milliseconds(2));
  ASSERT_TRUE(first);
  double squares = 0.0;
  for (const FramePose& pose : result->trajectory) {
    const auto truth = poseAt(*reference, pose.timestamp, std::chrono::milliseconds(2));
    if (pose.scan_from_camera && truth) {
      squares += (pose.scan_from_camera->translation() - first->inverse() * truth->translation())
                     .squaredNorm();
    }
  }
  EXPECT_LE(std::sqrt(squares / result->frames_tracked), 15.0);
}

}  // namespace
}  // namespace tarsus
