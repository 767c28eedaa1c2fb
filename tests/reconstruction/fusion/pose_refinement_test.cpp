// Poses that are wrong on purpose, on a scene whose truth is known.
#include "reconstruction/fusion/pose_refinement.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/surface_refinement.h"
#include "tests/reconstruction/fusion/perturbed_scan.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

constexpr int kFrames = 14;
constexpr double kStep_rad = 0.03;  // 12 mm a frame

/// A scan whose poses are off, with the field and the surface that these poses make.
struct WrongScan {
  std::vector<RigidTransform> truth;
  Trajectory trajectory;
  std::vector<FramePoints> points;
  ScanArchive archive;
  TsdfVolume field;
  TriangleMesh surface;
};

TsdfVolume fieldFrom(const ScanArchive& archive, const Trajectory& trajectory, double voxel_mm) {
  TsdfOptions options;
  options.voxel_size_mm = voxel_mm;
  options.weighting = TsdfWeighting::tracking();
  options.with_color = false;
  return *fuseScan(archive, trajectory, {}, options, {});
}

std::vector<FramePoints> pointsOf(const std::vector<RgbdFrame>& frames) {
  std::vector<FramePoints> points;
  for (const RgbdFrame& frame : frames) {
    points.push_back(alignmentPoints(fitDepthPlanes(smallCamera().depth, frame.depth, {}), 4));
  }
  return points;
}

WrongScan wrongScan(const AnalyticScene& scene, Depth depth) {
  std::vector<RigidTransform> truth = arcPoses(kFrames, kStep_rad);
  const auto frames = framesOf(scene, truth, depth);
  Trajectory trajectory = trajectoryOf(perturbed(truth, 2.0, 0.5));
  ScanArchive archive = archiveOf(frames);
  TsdfVolume field = fieldFrom(archive, trajectory, 2.0);
  TriangleMesh surface = field.extractSurface(3.0F).mesh;
  return {.truth = std::move(truth),
          .trajectory = std::move(trajectory),
          .points = pointsOf(frames),
          .archive = std::move(archive),
          .field = std::move(field),
          .surface = std::move(surface)};
}

double worstPose(const Trajectory& trajectory, const std::vector<RigidTransform>& truth) {
  double worst = 0.0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (trajectory[i].scan_from_camera) {
      worst = std::max(worst, poseError(*trajectory[i].scan_from_camera, truth[i]));
    }
  }
  return worst;
}

Expected<PoseRefinementResult> refineOnField(const WrongScan& scan,
                                             const PoseRefinementOptions& options = {.sweeps = 8},
                                             const Job& job = {}) {
  return refinePoses(scan.field, scan.points, scan.trajectory, options, job);
}

Expected<PoseRefinementResult> refineOnSurface(const WrongScan& scan,
                                               const PoseRefinementOptions& options = {.sweeps = 8},
                                               const Job& job = {}) {
  return refinePoses(scan.surface, scan.archive, scan.trajectory, options, job);
}

void expectSamePose(const std::optional<RigidTransform>& a,
                    const std::optional<RigidTransform>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (a) {
    EXPECT_EQ(a->matrix(), b->matrix());
  }
}

/// What a pose may be off after refinement. Exact depth is rounded to 1/64 mm and interpolated on
/// a field of 2 mm voxels; noise of 0.4 mm over some thousand readings gives a few hundredths, the
/// normals of a surface made of 14 noisy frames some more.
double allowed_mm(Depth depth) { return depth == Depth::Exact ? 0.1 : 0.2; }

TEST(RefinePoses, ComeBackOnARightField) {
  for (const Depth depth : {Depth::Exact, Depth::Noisy}) {
    const WrongScan scan = wrongScan(bumpyScene(), depth);
    ASSERT_GT(worstPose(scan.trajectory, scan.truth), 1.5);
    const TsdfVolume field = fieldFrom(scan.archive, trajectoryOf(scan.truth), 2.0);
    const auto refined = refinePoses(field, scan.points, scan.trajectory, {.sweeps = 8}, {});
    ASSERT_TRUE(refined);
    EXPECT_LE(worstPose(refined->trajectory, scan.truth), allowed_mm(depth));
  }
}

TEST(RefinePoses, ComeBackOnTheSurfaceThatTheyMadeThemselves) {
  for (const Depth depth : {Depth::Exact, Depth::Noisy}) {
    const WrongScan scan = wrongScan(bumpyScene(), depth);
    const auto refined = refineOnSurface(scan);
    ASSERT_TRUE(refined);
    EXPECT_LE(worstPose(refined->trajectory, scan.truth), allowed_mm(depth));
  }
}

TEST(RefinePoses, FieldFirstThenItsNewSurfaceAsTheReconstructionDoes) {
  for (const Depth depth : {Depth::Exact, Depth::Noisy}) {
    const WrongScan scan = wrongScan(bumpyScene(), depth);
    const auto first = refineOnField(scan, {});
    ASSERT_TRUE(first);
    // The field is smeared by the errors of the poses that made it, and hands some of that on.
    EXPECT_LE(worstPose(first->trajectory, scan.truth),
              worstPose(scan.trajectory, scan.truth) / 3.0);
    TsdfOptions options;
    options.with_color = false;
    const auto fused = fuseScan(scan.archive, first->trajectory, {}, options, {});
    ASSERT_TRUE(fused);
    const auto placed = refineSurface(
        fused->extractSurface(3.0F), scan.archive, first->trajectory, {.sweeps = 1}, {});
    ASSERT_TRUE(placed);
    const auto second = refinePoses(placed->mesh, scan.archive, first->trajectory, {}, {});
    ASSERT_TRUE(second);
    // One turn of surface and poses, on vertices that 14 noisy frames place to 0.1 mm each, leaves
    // a tenth of what was wrong; on the surface of the right poses it is half of that.
    EXPECT_LE(
        worstPose(second->trajectory, scan.truth),
        depth == Depth::Exact ? allowed_mm(depth) : 0.13 * worstPose(scan.trajectory, scan.truth));
  }
}

TEST(RefinePoses, TheFirstPoseStaysAndFramesWithoutPoseStayWithout) {
  WrongScan scan = wrongScan(bumpyScene(), Depth::Exact);
  scan.trajectory[0].scan_from_camera.reset();
  scan.trajectory[5].scan_from_camera.reset();
  const RigidTransform anchor = *scan.trajectory[1].scan_from_camera;
  for (const bool on_field : {true, false}) {
    const auto refined = on_field ? refineOnField(scan) : refineOnSurface(scan);
    ASSERT_TRUE(refined);
    ASSERT_EQ(refined->trajectory.size(), scan.trajectory.size());
    EXPECT_FALSE(refined->trajectory[0].scan_from_camera);
    EXPECT_FALSE(refined->trajectory[5].scan_from_camera);
    EXPECT_EQ(refined->trajectory[1].scan_from_camera->matrix(), anchor.matrix());
    for (std::size_t i = 0; i < scan.trajectory.size(); ++i) {
      EXPECT_EQ(refined->trajectory[i].frame_index, scan.trajectory[i].frame_index);
      EXPECT_EQ(refined->trajectory[i].timestamp, scan.trajectory[i].timestamp);
    }
    // Against the pinned frame, which is off itself, the others are right.
    const RigidTransform off = anchor * scan.truth[1].inverse();
    for (std::size_t i = 2; i < scan.trajectory.size(); ++i) {
      if (i != 5) {
        EXPECT_LE(poseError(*refined->trajectory[i].scan_from_camera, off * scan.truth[i]), 0.25);
      }
    }
  }
}

TEST(RefinePoses, OneTrackedFrameOrNoneIsLeftAlone) {
  WrongScan scan = wrongScan(bumpyScene(), Depth::Exact);
  for (std::size_t i = 0; i < scan.trajectory.size(); ++i) {
    if (i != 3) {
      scan.trajectory[i].scan_from_camera.reset();
    }
  }
  const auto one = refineOnField(scan);
  ASSERT_TRUE(one);
  expectSamePose(one->trajectory[3].scan_from_camera, scan.trajectory[3].scan_from_camera);
  scan.trajectory[3].scan_from_camera.reset();
  const auto none = refineOnSurface(scan);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->trajectory[3].scan_from_camera);
}

TEST(RefinePoses, StopsWhenAsked) {
  const WrongScan scan = wrongScan(bumpyScene(), Depth::Exact);
  std::stop_source stop;
  int reports = 0;
  Job job;
  job.stop = stop.get_token();
  job.report = [&](std::string_view, double) {
    ++reports;
    stop.request_stop();
  };
  const auto on_field = refineOnField(scan, {.sweeps = 8}, job);
  ASSERT_FALSE(on_field);
  EXPECT_EQ(on_field.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(reports, 1);  // after the sweep under way
  const auto on_surface = refineOnSurface(scan, {.sweeps = 8}, job);
  ASSERT_FALSE(on_surface);
  EXPECT_EQ(on_surface.error().code, ErrorCode::Cancelled);
}

TEST(RefinePoses, SameBitsWithOneThreadAndTwo) {
  const WrongScan scan = wrongScan(bumpyScene(), Depth::Noisy);
  for (const bool on_field : {true, false}) {
    const auto refinedWith = [&](int threads) {
      const ThreadLimit limit(threads);
      return on_field ? *refineOnField(scan, {.sweeps = 2}) : *refineOnSurface(scan, {.sweeps = 2});
    };
    const PoseRefinementResult one = refinedWith(1);
    const PoseRefinementResult two = refinedWith(2);
    for (std::size_t i = 0; i < scan.trajectory.size(); ++i) {
      expectSamePose(one.trajectory[i].scan_from_camera, two.trajectory[i].scan_from_camera);
    }
    EXPECT_EQ(one.refined_from_field.matrix(), two.refined_from_field.matrix());
  }
}

/// Distance and tilt of the wall as a pose places it, against the truth [mm; tilt 100 mm out].
double wallError(const RigidTransform& pose, const RigidTransform& truth, const Plane& wall) {
  const RigidTransform between = pose * truth.inverse();
  const Eigen::Vector3d on_wall = wall.normal * wall.offset_mm;
  const double distance = wall.normal.dot(between * on_wall) - wall.offset_mm;
  const double tilt = (between.linear() * wall.normal).cross(wall.normal).norm();
  return std::abs(distance) + 100.0 * tilt;
}

TEST(RefinePoses, AlongABareWallNothingRunsAway) {
  AnalyticScene scene;
  scene.planes = {{Eigen::Vector3d(0.1, 0.2, 1.0).normalized(), 400.0}};
  const PoseRefinementOptions usual;  // each sweep may creep a little further
  for (const Depth depth : {Depth::Exact, Depth::Noisy}) {
    const WrongScan scan = wrongScan(scene, depth);
    for (const bool on_field : {true, false}) {
      const auto refined = on_field ? refineOnField(scan, usual) : refineOnSurface(scan, usual);
      ASSERT_TRUE(refined);
      for (std::size_t i = 1; i < scan.trajectory.size(); ++i) {
        const RigidTransform& pose = *refined->trajectory[i].scan_from_camera;
        // What the wall fixes is found: distance and two tilts.
        EXPECT_LE(wallError(pose, scan.truth[i], scene.planes.front()), 0.2) << i;
        // Along it and about its normal, no pose goes further than twice what it might be off.
        EXPECT_LE(poseError(pose, *scan.trajectory[i].scan_from_camera), 2.0 * 2.9) << i;
      }
    }
  }
}

}  // namespace
}  // namespace tarsus
