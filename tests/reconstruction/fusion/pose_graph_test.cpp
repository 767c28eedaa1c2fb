#include "reconstruction/fusion/pose_graph.h"

#include "reconstruction/base/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kPoses = 100;
const Eigen::Vector3d kCenterCamera(0.0, 0.0, 400.0);

/// On a circle of 400 mm about what all cameras look at.
RigidTransform onCircle(int k) {
  const Eigen::Vector3d pivot = kCenterCamera;
  return Eigen::Translation3d(pivot) *
         Eigen::AngleAxisd(2.0 * std::numbers::pi * k / (kPoses - 1), Eigen::Vector3d::UnitY()) *
         Eigen::Translation3d(-pivot);
}

RigidTransform shifted(const Eigen::Vector3d& by) {
  RigidTransform motion = RigidTransform::Identity();
  motion.translation() = by;
  return motion;
}

/// A closed circle whose poses slide away evenly, up to `drift` at the end.
struct DriftingCircle {
  explicit DriftingCircle(const Eigen::Vector3d& drift) {
    for (int k = 0; k < kPoses; ++k) {
      truth.push_back(onCircle(k));
      poses.push_back(shifted(drift * k / (kPoses - 1)) * truth.back());
    }
    for (std::size_t k = 1; k < poses.size(); ++k) {
      edges.push_back({.a = k - 1,
                       .b = k,
                       .a_from_b = poses[k - 1].inverse() * poses[k],
                       .center_b = kCenterCamera,
                       .sqrt_information = MotionMatrix::Identity() / 2.0});
    }
  }

  /// An edge as it is in truth, or off by some motion, known to 0.1 mm.
  void join(std::size_t a, std::size_t b, const Eigen::Vector3d& off) {
    edges.push_back({.a = a,
                     .b = b,
                     .a_from_b = truth[a].inverse() * shifted(off) * truth[b],
                     .center_b = kCenterCamera,
                     .sqrt_information = MotionMatrix::Identity() / 0.1,
                     .may_be_false = true});
  }

  std::vector<RigidTransform> truth, poses;
  std::vector<PoseEdge> edges;
};

/// How far what the cameras look at moved from where it is in truth [mm].
double farthest(const std::vector<RigidTransform>& poses,
                const std::vector<RigidTransform>& truth) {
  double result = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    result = std::max(result, (poses[k] * kCenterCamera - truth[k] * kCenterCamera).norm());
  }
  return result;
}

TEST(SolvePoseGraph, WithoutLoopsNothingMoves) {
  const DriftingCircle circle({20.0, 5.0, 0.0});
  const auto solved = solvePoseGraph(circle.poses, circle.edges, {});
  ASSERT_EQ(solved.size(), circle.poses.size());
  EXPECT_LT(farthest(solved, circle.poses), 1e-6);
}

TEST(SolvePoseGraph, SpreadsEvenDriftAndKeepsTheFirstPose) {
  DriftingCircle circle({15.0, 10.0, -8.0});
  circle.join(0, kPoses - 1, Eigen::Vector3d::Zero());
  EXPECT_GT(farthest(circle.poses, circle.truth), 19.0);
  const auto solved = solvePoseGraph(circle.poses, circle.edges, {});
  EXPECT_EQ(solved.front().matrix(), circle.poses.front().matrix());
  // Even steps, equally uncertain: the exact answer is the truth but for the loop's own 0.1 mm
  // against 20 mm of the whole chain (20 mm * 0.1^2 / 20^2), and the chord of the turning steps.
  EXPECT_LT(farthest(solved, circle.truth), 0.3);
}

TEST(SolvePoseGraph, OneFalseEdgeDoesNotTearIt) {
  DriftingCircle circle({15.0, 10.0, -8.0});
  circle.join(0, kPoses - 1, Eigen::Vector3d::Zero());
  circle.join(3, kPoses - 1, Eigen::Vector3d::Zero());
  const auto right = solvePoseGraph(circle.poses, circle.edges, {});
  circle.join(30, 60, {80.0, 0.0, 60.0});  // 100 mm off in a path of 2.5 m
  const auto solved = solvePoseGraph(circle.poses, circle.edges, {});
  // Left out altogether, not merely held weakly.
  EXPECT_LT(farthest(solved, right), 1e-6);
}

TEST(SolvePoseGraph, AFalseEdgeAlongsideTrueOnesIsOutvoted) {
  DriftingCircle circle({15.0, 10.0, -8.0});
  circle.join(0, kPoses - 1, Eigen::Vector3d::Zero());
  circle.join(2, kPoses - 3, Eigen::Vector3d::Zero());
  const auto right = solvePoseGraph(circle.poses, circle.edges, {});
  circle.join(1, kPoses - 2, {0.0, 60.0, 0.0});
  EXPECT_LT(farthest(solvePoseGraph(circle.poses, circle.edges, {}), right), 1e-6);
}

TEST(SolvePoseGraph, AnEdgeWithoutInformationAlongADirectionLeavesIt) {
  DriftingCircle circle({12.0, 9.0, 0.0});
  circle.join(0, kPoses - 1, Eigen::Vector3d::Zero());
  // The last camera stands where the first one did: y of its axes is y of the scan.
  circle.edges.back().sqrt_information(4, 4) = 0.0;
  const auto solved = solvePoseGraph(circle.poses, circle.edges, {});
  const Eigen::Vector3d off = solved.back() * kCenterCamera - circle.truth.back() * kCenterCamera;
  EXPECT_LT(std::abs(off.x()), 0.05);
  EXPECT_NEAR(off.y(), 9.0, 0.5);  // as far as turning and shifting the chain are coupled
}

TEST(SolvePoseGraph, SameBitsTwiceAndWithTwoThreads) {
  DriftingCircle circle({15.0, 10.0, -8.0});
  circle.join(0, kPoses - 1, Eigen::Vector3d::Zero());
  circle.join(30, 60, {80.0, 0.0, 60.0});
  const auto solved = [&](int threads) {
    const ThreadLimit limit(threads);
    return solvePoseGraph(circle.poses, circle.edges, {});
  };
  const auto once = solved(1);
  for (const auto& again : {solved(1), solved(2)}) {
    for (std::size_t k = 0; k < once.size(); ++k) {
      EXPECT_EQ(once[k].matrix(), again[k].matrix());
    }
  }
}

}  // namespace
}  // namespace tarsus
