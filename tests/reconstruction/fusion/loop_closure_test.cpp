#include "reconstruction/fusion/loop_closure.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/pose_refinement.h"
#include "tests/reconstruction/fusion/analytic_scene.h"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr int kFrames = 120;
/// A little more than once round, so that the last views were there before.
constexpr double kOnceRound_rad = 1.03 * kTurn_rad;

/// Balls of different size about (0, 0, 400), which hold a camera from all sides.
AnalyticScene heap() {
  AnalyticScene scene;
  scene.spheres = {{{-45, -20, 390}, 45},
                   {{40, 35, 425}, 40},
                   {{30, -55, 380}, 30},
                   {{-20, 60, 380}, 28},
                   {{10, 0, 455}, 38},
                   {{0, 10, 345}, 26},
                   {{-50, 25, 440}, 24}};
  return scene;
}

RgbdCamera quickCamera() {
  RgbdCamera camera = smallCamera();
  camera.depth = {.width = 240,
                  .height = 180,
                  .fx_px = 230.0,
                  .fy_px = 230.0,
                  .cx_px = 119.5,
                  .cy_px = 89.5,
                  .distortion = {}};
  return camera;
}

/// Frames along an arc, with their points and true poses.
struct ArcScan {
  ArcScan(const AnalyticScene& scene, const std::vector<double>& angles)
      : archive(quickCamera(), static_cast<int>(angles.size())), points(angles.size()) {
    const Intrinsics camera = quickCamera().depth;
    std::vector<RgbdFrame> frames(angles.size());
    parallelFor(static_cast<int>(angles.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      frames[i] = frameOf(withNoise(scene.render(camera, arcPose(angles[i])), 1000 + i), k);
      points[i] = alignmentPoints(fitDepthPlanes(camera, frames[i].depth, {}), 2);
    });
    for (std::size_t i = 0; i < angles.size(); ++i) {
      archive.add(frames[i]);
      FramePose pose;
      pose.frame_index = static_cast<int>(i);
      pose.timestamp = frames[i].timestamp;
      pose.scan_from_camera = arcPose(angles[i]);
      truth.push_back(pose);
    }
  }

  ScanArchive archive;
  std::vector<FramePoints> points;
  Trajectory truth;
};

std::vector<double> arcOf(int count, double whole_rad) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) {
    angles.push_back(whole_rad * i / (count - 1));
  }
  return angles;
}

const ArcScan& roundScan() {
  static const ArcScan scan(heap(), arcOf(kFrames, kOnceRound_rad));
  return scan;
}

/// A turn about the middle of the scene and a shift, both times `share`.
RigidTransform driftOf(double share, double shift_mm, double turn_deg) {
  const Eigen::Vector3d pivot(0.0, 0.0, 400.0);
  const Eigen::Vector3d along = Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0;
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0;
  return Eigen::Translation3d(pivot + share * shift_mm * along) *
         Eigen::AngleAxisd(share * turn_deg * std::numbers::pi / 180.0, axis) *
         Eigen::Translation3d(-pivot);
}

/// Poses that slide away, slowly at first: a smooth step from nothing to all.
Trajectory drifting(const Trajectory& truth, double shift_mm, double turn_deg) {
  Trajectory result = truth;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(result.size() - 1);
    result[i].scan_from_camera =
        driftOf(s * s * (3.0 - 2.0 * s), shift_mm, turn_deg) * *truth[i].scan_from_camera;
  }
  return result;
}

/// RMS way of the later frame's points to where they lie in truth, seen from the earlier frame.
double knownResidual(const ArcScan& scan, const Trajectory& poses, const Loop& loop) {
  const auto e = static_cast<std::size_t>(loop.earlier);
  const auto l = static_cast<std::size_t>(loop.later);
  const RigidTransform right = *poses[e].scan_from_camera *
                               scan.truth[e].scan_from_camera->inverse() *
                               *scan.truth[l].scan_from_camera;
  double squares = 0.0;
  for (const AlignmentPoint& point : scan.points[l]) {
    const Eigen::Vector3d p = point.p_camera.cast<double>();
    squares += (right * p - *poses[l].scan_from_camera * p).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(scan.points[l].size()));
}

/// How far the middle of the scene, as each frame sees it, lies from where it is in truth [mm].
double farthestMiddle(const Trajectory& poses, const Trajectory& truth) {
  const Eigen::Vector3d middle(0.0, 0.0, 400.0);
  double farthest = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RigidTransform off = *poses[i].scan_from_camera * truth[i].scan_from_camera->inverse();
    farthest = std::max(farthest, (off * middle - middle).norm());
  }
  return farthest;
}

LoopReport checked(const ArcScan& scan, const Trajectory& poses) {
  auto report = checkLoops(scan.archive, scan.points, poses, {}, {});
  EXPECT_TRUE(report);
  return std::move(*report);
}

TEST(FindLoops, OnceRoundComesBack) {
  const auto pairs = findLoops(roundScan().truth, roundScan().points, {});
  ASSERT_FALSE(pairs.empty());
  EXPECT_LE(pairs.size(), 6U);
  for (const FramePair& pair : pairs) {
    EXPECT_GE(pair.later - pair.earlier, 50);
    EXPECT_GE(pair.overlap, 0.5);
    EXPECT_LE(
        viewChange(*roundScan().truth[static_cast<std::size_t>(pair.earlier)].scan_from_camera,
                   *roundScan().truth[static_cast<std::size_t>(pair.later)].scan_from_camera,
                   400.0),
        0.5);
  }
}

TEST(FindLoops, AnArcRestAndAnOpenCircleDoNot) {
  const ArcScan arc(heap(), arcOf(40, 2.0));
  EXPECT_TRUE(findLoops(arc.truth, arc.points, {}).empty());
  const ArcScan rest(heap(), std::vector<double>(40, 0.3));
  EXPECT_TRUE(findLoops(rest.truth, rest.points, {}).empty());
  const ArcScan open(heap(), arcOf(60, 0.85 * kTurn_rad));
  EXPECT_TRUE(findLoops(open.truth, open.points, {}).empty());
  const auto report = checkLoops(open.archive, open.points, open.truth, {}, {});
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->residual_mm);
  EXPECT_TRUE(report->loops.empty());
}

TEST(FindLoops, FramesWithoutPoseAreNoVisits) {
  Trajectory poses = roundScan().truth;
  for (std::size_t i = 90; i < poses.size(); ++i) {
    poses[i].scan_from_camera.reset();  // lost before it came back
  }
  EXPECT_TRUE(findLoops(poses, roundScan().points, {}).empty());
  EXPECT_TRUE(findLoops({}, {}, {}).empty());
}

TEST(CheckLoops, TruePosesLeaveOnlyTheNoise) {
  const LoopReport report = checked(roundScan(), roundScan().truth);
  ASSERT_TRUE(report.residual_mm);
  EXPECT_EQ(report.unmeasured, 0);
  // What a measurement of this kind errs by; the limit on a real loop is 0.3 mm.
  EXPECT_LT(*report.residual_mm, 0.15);
}

TEST(CheckLoops, MeasuresKnownDriftWithinFifteenPercent) {
  for (const double share : {0.1, 0.4, 1.0}) {
    const Trajectory poses = drifting(roundScan().truth, 20.0 * share, 3.0 * share);
    const LoopReport report = checked(roundScan(), poses);
    ASSERT_TRUE(report.residual_mm);
    EXPECT_EQ(report.unmeasured, 0);
    for (const Loop& loop : report.loops) {
      const double known = knownResidual(roundScan(), poses, loop);
      EXPECT_NEAR(loop.residual_mm, known, 0.15 * known) << loop.earlier << ' ' << loop.later;
      EXPECT_EQ(loop.free_directions, 0);
    }
    EXPECT_GT(*report.residual_mm, 15.0 * share);
  }
}

TEST(CloseLoops, EndsMeetAndRefinementMakesThemAgree) {
  const ArcScan& scan = roundScan();
  const Trajectory poses = drifting(scan.truth, 20.0, 3.0);
  const Trajectory closed = closeLoops(poses, checked(scan, poses).loops, {});
  EXPECT_EQ(closed.front().scan_from_camera->matrix(), poses.front().scan_from_camera->matrix());
  EXPECT_LE(*checked(scan, closed).residual_mm, 1.0);
  // In between the drift was not even: a smooth step lies up to a tenth of its height, 2 mm, off
  // the straight line that the graph makes of it, and the turn adds to that.
  EXPECT_GT(farthestMiddle(poses, scan.truth), 19.0);
  EXPECT_LT(farthestMiddle(closed, scan.truth), 3.0);

  TsdfOptions field;
  field.voxel_size_mm = 2.0;
  field.weighting = TsdfWeighting::tracking();
  field.with_color = false;
  const auto fused = fuseScan(scan.archive, closed, {}, field, {});
  ASSERT_TRUE(fused);
  const auto refined = refinePoses(*fused, scan.points, closed, {}, {});
  ASSERT_TRUE(refined);
  const LoopReport report = checked(scan, refined->trajectory);
  ASSERT_TRUE(report.residual_mm);
  EXPECT_LE(*report.residual_mm, 0.3);  // the limit on a closed path
}

TEST(CloseLoops, AFalseLoopDoesNotTearThePath) {
  const ArcScan& scan = roundScan();
  const Trajectory poses = drifting(scan.truth, 20.0, 3.0);
  std::vector<Loop> loops = checked(scan, poses).loops;
  const Trajectory right = closeLoops(poses, loops, {});
  Loop wrong = loops.front();
  wrong.earlier = 30;
  wrong.later = 90;
  wrong.earlier_from_later = RigidTransform::Identity();  // opposite sides of the heap
  loops.push_back(wrong);
  const Trajectory closed = closeLoops(poses, loops, {});
  for (std::size_t i = 0; i < closed.size(); ++i) {
    EXPECT_LT((closed[i].scan_from_camera->matrix() - right[i].scan_from_camera->matrix()).norm(),
              1e-6);
  }
}

TEST(CloseLoops, WithoutLoopsThePathStaysAsItIs) {
  const Trajectory closed = closeLoops(roundScan().truth, {}, {});
  for (std::size_t i = 0; i < closed.size(); ++i) {
    EXPECT_EQ(closed[i].scan_from_camera->matrix(),
              roundScan().truth[i].scan_from_camera->matrix());
  }
}

TEST(CloseLoops, LostFramesStayLost) {
  Trajectory poses = drifting(roundScan().truth, 10.0, 1.0);
  for (std::size_t i = 40; i < 44; ++i) {
    poses[i].scan_from_camera.reset();
  }
  const Trajectory closed = closeLoops(poses, checked(roundScan(), poses).loops, {});
  EXPECT_FALSE(closed[41].scan_from_camera);
  EXPECT_LE(*checked(roundScan(), closed).residual_mm, 1.0);
}

TEST(MeasureLoop, DirectionsThatAPlaneLeavesFreeDoNotCount) {
  AnalyticScene wall;
  wall.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  const ArcScan scan(wall, std::vector<double>(12, 0.0));
  Trajectory poses = scan.truth;
  // The later half slid along the wall by 6 mm, which nothing can tell, and came 2 mm nearer.
  for (std::size_t i = 6; i < poses.size(); ++i) {
    poses[i].scan_from_camera->translation() += Eigen::Vector3d(6.0, 0.0, 2.0);
  }
  LoopMeasureOptions options;
  options.window_view_change_rad = 0.01;  // less than the slide: the halves stay apart
  const auto loop = measureLoop(
      scan.archive, scan.points, poses, {.earlier = 2, .later = 9, .overlap = 1.0}, options);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->free_directions, 3);
  EXPECT_NEAR(loop->residual_mm, 2.0, 0.05);
  const Eigen::SelfAdjointEigenSolver<MotionMatrix> eigen(loop->information);
  EXPECT_NEAR(eigen.eigenvalues()[2], 0.0, 1e-9);
  EXPECT_GT(eigen.eigenvalues()[3], 1.0);
}

TEST(MeasureLoop, ADifferentPlaceDoesNotFit) {
  // Opposite sides of the heap, posed as if they were one.
  const ArcScan& scan = roundScan();
  Trajectory poses = scan.truth;
  for (std::size_t i = 50; i < 70; ++i) {
    poses[i].scan_from_camera = poses[i - 50].scan_from_camera;
  }
  const auto loop = measureLoop(
      scan.archive, scan.points, poses, {.earlier = 5, .later = 60, .overlap = 1.0}, {});
  EXPECT_FALSE(loop);
}

TEST(CheckLoops, SameBitsTwiceAndWithTwoThreads) {
  const Trajectory poses = drifting(roundScan().truth, 5.0, 1.0);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return checked(roundScan(), poses);
  };
  const LoopReport once = run(1);
  const Trajectory closed = closeLoops(poses, once.loops, {});
  for (const LoopReport& again : {run(1), run(2)}) {
    ASSERT_EQ(once.loops.size(), again.loops.size());
    EXPECT_EQ(*once.residual_mm, *again.residual_mm);
    const Trajectory closed_again = closeLoops(poses, again.loops, {});
    for (std::size_t i = 0; i < closed.size(); ++i) {
      EXPECT_EQ(closed[i].scan_from_camera->matrix(), closed_again[i].scan_from_camera->matrix());
    }
  }
}

TEST(CheckLoops, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  Job job;
  job.stop = stop.get_token();
  const auto report =
      checkLoops(roundScan().archive, roundScan().points, roundScan().truth, {}, job);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace tarsus
