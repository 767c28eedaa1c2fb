#include "reconstruction/capture/simulator/visit.h"

#include "reconstruction/capture/simulator/foot_shape.h"
#include "reconstruction/scene/mesh_index.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

std::shared_ptr<const SimulatedScene> sceneOf(SimulatorOptions options) {
  options.frames = 2;
  const auto scene = buildScene(options);
  EXPECT_TRUE(scene);
  return scene ? *scene : nullptr;
}

double degrees(const RigidTransform& transform) {
  return Eigen::AngleAxisd(transform.linear()).angle() * 180.0 / M_PI;
}

TEST(Visit, TheFirstIsAsItAlwaysWas) {
  const VisitPose pose = visitPose(0);
  EXPECT_TRUE(pose.room_from_foot.matrix().isIdentity(0.0));
  EXPECT_EQ(pose.toe_bend_rad, 0.0);
  EXPECT_EQ(weeksLater({}, HealingCourse::Shrinking, 0).posed, 0U);
}

/// Area follows the square of the rim's lengths, volume also the depth; what the wall takes away
/// of a bowl changes a little with its size.
TEST(Visit, UlcersChangeByWhatIsAskedFor) {
  SimulatorOptions options;
  options.foot = FootCase::Heel;
  const WoundTruth before = sceneOf(options)->wounds.front();
  options.area_factor = 0.8;
  options.depth_factor = 0.875;
  const WoundTruth after = sceneOf(options)->wounds.front();
  EXPECT_NEAR(after.opening_area_mm2 / before.opening_area_mm2, 0.8, 0.01);
  EXPECT_NEAR(after.volume_mm3 / before.volume_mm3, 0.7, 0.03);
  EXPECT_NEAR(after.p99_depth_mm / before.p99_depth_mm, 0.875, 0.03);
}

TEST(Visit, AnUlcerHealedAcrossIsTwoWithSkinBetween) {
  SimulatorOptions options;
  options.split = true;
  const auto scene = sceneOf(options);
  ASSERT_EQ(scene->wounds.size(), 2U);
  double nearest_mm = 1e9;
  for (const auto& p : scene->wounds[0].outline_mm) {
    for (const auto& q : scene->wounds[1].outline_mm) {
      nearest_mm = std::min(nearest_mm, (p - q).norm());
    }
  }
  EXPECT_GT(nearest_mm, 2.0);  // a bridge of skin that a camera sees
  EXPECT_LT(nearest_mm, 15.0);
}

/// The skin of two visits is one surface but for the ulcer and the toes.
TEST(Visit, SkinIsTheSameInTheFrameOfTheFoot) {
  SimulatorOptions options;
  const auto first = sceneOf(options);
  options.posed = 7;
  const auto later = sceneOf(options);
  const RigidTransform later_from_first = later->scan_from_foot * first->scan_from_foot.inverse();
  EXPECT_GT(degrees(later_from_first), 3.0);
  const MeshIndex index(later->intact_foot);
  double farthest_mm = 0.0;
  double toes_mm = 0.0;
  for (const Eigen::Vector3f& vertex : first->intact_foot.vertices) {
    const Eigen::Vector3d p = vertex.cast<double>();
    const double x = (first->scan_from_foot.inverse() * p).x();
    const double off_mm = index.nearest(later_from_first * p, 50.0)->distance_mm;
    double& worst = x < 170.0 ? farthest_mm : toes_mm;
    worst = std::max(worst, off_mm);
  }
  EXPECT_LT(farthest_mm, 0.05);  // the two meshes divide the same surface otherwise
  EXPECT_GT(toes_mm, 1.0);       // they bend
}

TEST(Visit, PosesDifferWithinTheirBounds) {
  double most_deg = 0.0;
  for (std::uint64_t posed = 1; posed <= 100; ++posed) {
    const VisitPose pose = visitPose(posed);
    most_deg = std::max(most_deg, degrees(pose.room_from_foot));
    EXPECT_LE(pose.toe_bend_rad, 0.3);
    EXPECT_GE(pose.toe_bend_rad, -0.15);
    for (const double gain : pose.light) {
      EXPECT_GT(gain, 0.7);
      EXPECT_LT(gain, 1.15);
    }
  }
  EXPECT_GT(most_deg, 10.0);
  EXPECT_LT(most_deg, 18.0);  // three turns of 10 degrees
}

TEST(Visit, AToeBendsAsAWhole) {
  const FootShape straight;
  const FootShape bent(0.3);
  const RigidTransform bend = bentToe(0, 0.3);
  const Eigen::Vector3d pulp(243.0, 30.0, 14.8);  // of the big toe, within it
  EXPECT_NEAR(bent.distance(bend * pulp), straight.distance(pulp), 0.05);
  EXPECT_LT((bend * pulp).z(), pulp.z() - 5.0);  // towards the sole
}

TEST(Visit, CoursesGoTheirWay) {
  const SimulatorOptions first;
  EXPECT_LT(weeksLater(first, HealingCourse::Shrinking, 4).area_factor, 0.55);
  EXPECT_GT(weeksLater(first, HealingCourse::Deepening, 4).depth_factor, 1.3);
  EXPECT_LT(weeksLater(first, HealingCourse::Filling, 4).depth_factor, 0.5);
  EXPECT_FALSE(weeksLater(first, HealingCourse::Splitting, 5).split);
  EXPECT_TRUE(weeksLater(first, HealingCourse::Splitting, 6).split);
  EXPECT_NE(weeksLater(first, HealingCourse::Filling, 1).posed,
            weeksLater(first, HealingCourse::Filling, 2).posed);
  EXPECT_EQ(healingCourseNamed(nameOf(HealingCourse::Splitting)), HealingCourse::Splitting);
}

TEST(Visit, NonsenseIsRefused) {
  SimulatorOptions options;
  options.area_factor = 0.0;
  EXPECT_EQ(buildScene(options).error().code, ErrorCode::BadOption);
  options.area_factor = 1.0;
  options.depth_factor = std::nan("");
  EXPECT_EQ(buildScene(options).error().code, ErrorCode::BadOption);
}

}  // namespace
}  // namespace tarsus
