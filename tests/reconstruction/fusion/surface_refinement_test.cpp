#include "reconstruction/fusion/surface_refinement.h"

#include "reconstruction/base/parallel.h"
#include "tests/reconstruction/fusion/perturbed_scan.h"
#include "tests/reconstruction/scene/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tarsus {
namespace {

const Eigen::Vector3d kCenter(0.0, 0.0, 400.0);
constexpr double kRadius_mm = 50.0;

ExtractedSurface extractedFrom(TriangleMesh mesh) {
  ExtractedSurface surface;
  mesh.normals = vertexNormals(mesh);
  surface.sigma_mm.resize(mesh.vertices.size());
  surface.observations.resize(mesh.vertices.size());
  surface.mesh = std::move(mesh);
  return surface;
}

ExtractedSurface sphereSurface(double radius_mm) {
  TriangleMesh mesh = makeSphere(radius_mm, 60);
  for (Eigen::Vector3f& p : mesh.vertices) {
    p += kCenter.cast<float>();
  }
  return extractedFrom(std::move(mesh));
}

/// Upright wall at this depth, over [-half, half]^2, faces towards the camera at the origin.
ExtractedSurface wallSurface(double half_mm, double z_mm) {
  TriangleMesh mesh = makePlane(2.0 * half_mm, 40, 0.0);
  const auto half = static_cast<float>(half_mm);
  for (Eigen::Vector3f& p : mesh.vertices) {
    p = {p.x() - half, half - p.y(), static_cast<float>(z_mm)};
  }
  return extractedFrom(std::move(mesh));
}

AnalyticScene ball() {
  AnalyticScene scene;
  scene.spheres = {{kCenter, kRadius_mm}};
  return scene;
}

/// The same 26 views three times over, with different noise.
std::vector<RigidTransform> manyViews() {
  std::vector<RigidTransform> poses;
  for (int round = 0; round < 3; ++round) {
    const auto around = posesAllAround(350.0);
    poses.insert(poses.end(), around.begin(), around.end());
  }
  return poses;
}

struct HeightError {
  double mean_mm = 0.0;
  double rms_mm = 0.0;
};

HeightError errorOnBall(const ExtractedSurface& surface) {
  double sum = 0.0;
  double squares = 0.0;
  for (const Eigen::Vector3f& p : surface.mesh.vertices) {
    const double height = (p.cast<double>() - kCenter).norm() - kRadius_mm;
    sum += height;
    squares += height * height;
  }
  const double count = static_cast<double>(surface.mesh.vertices.size());
  return {sum / count, std::sqrt(squares / count)};
}

TEST(RefineSurface, AnInflatedBallReturnsToItsSize) {
  const auto poses = manyViews();
  const auto frames = framesOf(ball(), poses, Depth::Noisy);
  const ExtractedSurface inflated = sphereSurface(kRadius_mm + 0.3);
  const auto refined =
      refineSurface(inflated, archiveOf(frames), trajectoryOf(poses), {.sweeps = 3}, {});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->mesh.faces.size(), inflated.mesh.faces.size());  // seen from all sides
  const HeightError error = errorOnBall(*refined);
  // Two of about 25 observations are the inflated surface's own opinion: 0.3 mm (2/27)^3 remain;
  // interpolation on the depth image adds 1.2^2 / 8R = 0.004 mm seen head-on, more obliquely.
  EXPECT_NEAR(error.mean_mm, 0.0, 0.05);
  // One reading errs by 0.34 mm, interpolated between four pixels by two thirds of it; 25 of them
  // by 0.05 mm.
  EXPECT_LT(error.rms_mm, 0.1);
}

TEST(RefineSurface, ExactFramesLeaveATrueSurfaceWhereItIs) {
  const auto poses = posesAllAround(350.0);
  const auto frames = framesOf(ball(), poses, Depth::Exact);
  const auto refined = refineSurface(
      sphereSurface(kRadius_mm), archiveOf(frames), trajectoryOf(poses), {.sweeps = 2}, {});
  ASSERT_TRUE(refined);
  const HeightError error = errorOnBall(*refined);
  EXPECT_NEAR(error.mean_mm, 0.0, 0.02);  // the archive's 1/64 mm and the interpolation
  EXPECT_LT(error.rms_mm, 0.05);
}

TEST(RefineSurface, SigmaIsTheScatterOfTheHeights) {
  AnalyticScene wall;
  wall.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  constexpr int kFrames = 20;
  const std::vector<RigidTransform> poses(kFrames, RigidTransform::Identity());
  const auto frames = framesOf(wall, poses, Depth::Noisy);
  const auto refined = refineSurface(wallSurface(60.0, 400.0),
                                     archiveOf(frames),
                                     trajectoryOf(poses),
                                     {.sweeps = 1, .prior_observations = 0.0},
                                     {});
  ASSERT_TRUE(refined);
  double squares = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < refined->mesh.vertices.size(); ++i) {
    squares += std::pow(static_cast<double>(refined->mesh.vertices[i].z()) - 400.0, 2);
    variance += std::pow(static_cast<double>(refined->sigma_mm[i]), 2);
    EXPECT_EQ(refined->observations[i], kFrames);
  }
  const double count = static_cast<double>(refined->mesh.vertices.size());
  // 0.39 mm a pixel; between four pixels two thirds of it; over 20 frames.
  const double known = 0.39 * (2.0 / 3.0) / std::sqrt(kFrames);
  EXPECT_NEAR(std::sqrt(squares / count) / known, 1.0, 0.1);   // 1681 vertices: 2 %
  EXPECT_NEAR(std::sqrt(variance / count) / known, 1.0, 0.1);  // Tukey's weights take 3 % off
}

TEST(RefineSurface, ObservationsAreCountedAndTheUnseenIsTakenAway) {
  const std::vector<RigidTransform> poses = {arcPose(-0.02), arcPose(0.0), arcPose(0.02)};
  Trajectory trajectory = trajectoryOf(poses);
  trajectory.push_back({.frame_index = 3, .timestamp = frameOf({}, 3).timestamp});  // no pose
  auto frames = framesOf(ball(), poses, Depth::Exact);
  frames.push_back(frames[0]);
  const ExtractedSurface whole = sphereSurface(kRadius_mm);
  const auto refined = refineSurface(whole, archiveOf(frames), trajectory, {}, {});
  ASSERT_TRUE(refined);
  ASSERT_FALSE(refined->mesh.faces.empty());
  EXPECT_LT(refined->mesh.faces.size(), whole.mesh.faces.size() / 2);
  for (std::size_t i = 0; i < refined->mesh.vertices.size(); ++i) {
    EXPECT_LT(refined->mesh.vertices[i].z(), 400.0F);  // nothing of the back
    EXPECT_GE(refined->observations[i], 1);
    EXPECT_LE(refined->observations[i], 3);
    if ((refined->mesh.vertices[i].cast<double>() - Eigen::Vector3d(0, 0, 350)).norm() < 20.0) {
      EXPECT_EQ(refined->observations[i], 3);
    }
  }
}

TEST(RefineSurface, ColoursAreThoseOfTheFrames) {
  const std::vector<RigidTransform> poses = arcPoses(4, 0.03);
  AnalyticScene wall;
  wall.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  auto frames = framesOf(wall, poses, Depth::Exact);
  const Intrinsics& k = smallCamera().color;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].color = ColorImage(k.width, k.height);
    for (int v = 0; v < k.height; ++v) {
      for (int u = 0; u < k.width; ++u) {  // the wall is red where x < 0, blue elsewhere
        const double z = frames[i].depth.at(u, v);
        const bool red = (poses[i] * (k.ray(u, v) * z)).x() < 0.0;
        frames[i].color.at(u, v) = red ? Rgb8{200, 20, 10} : Rgb8{10, 20, 200};
      }
    }
  }
  const auto refined =
      refineSurface(wallSurface(60.0, 400.0), archiveOf(frames), trajectoryOf(poses), {}, {});
  ASSERT_TRUE(refined);
  ASSERT_EQ(refined->colors.size(), refined->mesh.vertices.size());
  for (std::size_t i = 0; i < refined->colors.size(); ++i) {
    const float x = refined->mesh.vertices[i].x();
    if (std::abs(x) > 2.0F) {  // off the border by more than a pixel
      EXPECT_EQ(refined->colors[i].r, x < 0.0F ? 200 : 10);
      EXPECT_EQ(refined->colors[i].g, 20);
      EXPECT_EQ(refined->colors[i].b, x < 0.0F ? 10 : 200);
    }
  }
}

TEST(RefineSurface, FlyingPixelsAtASteepEdgePullNothing) {
  // A step of 40 mm; the two columns of pixels along it lie anywhere between.
  constexpr int kEdge_px = 160;
  std::mt19937 dice(8);
  std::vector<RgbdFrame> frames;
  for (int i = 0; i < 20; ++i) {
    DepthImage depth(320, 240);
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const bool flying = u == kEdge_px || u == kEdge_px + 1;
        const float between = 380.0F + 0.125F * static_cast<float>(dice() % 321U);
        depth.at(u, v) = flying ? between : (u < kEdge_px ? 380.0F : 420.0F);
      }
    }
    frames.push_back(frameOf(std::move(depth), i));
  }
  const std::vector<RigidTransform> poses(frames.size(), RigidTransform::Identity());
  const auto refined =
      refineSurface(wallSurface(60.0, 380.0), archiveOf(frames), trajectoryOf(poses), {}, {});
  ASSERT_TRUE(refined);
  ASSERT_GT(refined->mesh.vertices.size(), 500U);
  // Up to the last sure pixel, the wall stays to the bit of its steps; in the half pixel beyond,
  // whose readings all lean on a flying pixel, the kernel bounds what they can do.
  const auto last_sure_mm = static_cast<float>((kEdge_px - 1 - 159.5) / 307.0 * 380.0);
  for (const Eigen::Vector3f& p : refined->mesh.vertices) {
    EXPECT_NEAR(p.z(), 380.0F, p.x() < last_sure_mm ? 0.001F : 2.5F) << p.transpose();
    EXPECT_LT(p.x(), 4.0F);  // beyond the edge the wall was not seen
  }
}

TEST(RefineSurface, NothingIsInterpolatedAcrossAStep) {
  DepthImage depth(320, 240);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      depth.at(u, v) = u < 160 ? 380.0F : 420.0F;
    }
  }
  const std::vector<RgbdFrame> frames(5, frameOf(std::move(depth), 0));
  const std::vector<RigidTransform> poses(frames.size(), RigidTransform::Identity());
  // Vertices 0.3 mm apart, a quarter of a pixel.
  const auto refined =
      refineSurface(wallSurface(6.0, 380.0), archiveOf(frames), trajectoryOf(poses), {}, {});
  ASSERT_TRUE(refined);
  ASSERT_GT(refined->mesh.vertices.size(), 500U);
  for (const Eigen::Vector3f& p : refined->mesh.vertices) {
    EXPECT_NEAR(p.z(), 380.0F, 0.001F) << p.transpose();
  }
}

TEST(RefineSurface, StopsWhenAskedAndGivesTheSameBitsWithTwoThreads) {
  const auto poses = posesAllAround(350.0);
  const auto frames = archiveOf(framesOf(ball(), poses, Depth::Noisy));
  const ExtractedSurface inflated = sphereSurface(kRadius_mm + 0.3);
  std::stop_source stop;
  stop.request_stop();
  Job job;
  job.stop = stop.get_token();
  EXPECT_EQ(refineSurface(inflated, frames, trajectoryOf(poses), {}, job).error().code,
            ErrorCode::Cancelled);
  const auto refinedWith = [&](int threads) {
    const ThreadLimit limit(threads);
    return *refineSurface(inflated, frames, trajectoryOf(poses), {}, {});
  };
  const ExtractedSurface one = refinedWith(1);
  const ExtractedSurface two = refinedWith(2);
  EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
  EXPECT_EQ(one.mesh.normals, two.mesh.normals);
  EXPECT_EQ(one.sigma_mm, two.sigma_mm);
  EXPECT_EQ(one.observations, two.observations);
}

}  // namespace
}  // namespace tarsus
