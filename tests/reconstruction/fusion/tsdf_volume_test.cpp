#include "reconstruction/fusion/tsdf_volume.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/surface_cleanup.h"
#include "tests/reconstruction/fusion/analytic_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace tarsus {
namespace {

/// Camera that looks at the scene's middle (0, 0, 400) from the direction given.
RigidTransform lookingFrom(const Eigen::Vector3d& direction, double distance_mm) {
  const Eigen::Vector3d forward = -direction.normalized();
  const Eigen::Vector3d hint =
      std::abs(forward.y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d right = hint.cross(forward).normalized();
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() << right, forward.cross(right), forward;
  pose.translation() = Eigen::Vector3d(0, 0, 400) - forward * distance_mm;
  return pose;
}

/// The 26 directions of a cube's neighbours.
std::vector<RigidTransform> allAround(double distance_mm) {
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d direction(i % 3 - 1, (i / 3) % 3 - 1, i / 9 - 1);
    if (direction.norm() > 0.0) {
      poses.push_back(lookingFrom(direction, distance_mm));
    }
  }
  return poses;
}

AnalyticScene ball(double radius_mm) {
  AnalyticScene scene;
  scene.spheres = {{{0, 0, 400}, radius_mm}};
  return scene;
}

TsdfOptions withVoxel(double voxel_mm) {
  TsdfOptions options;
  options.voxel_size_mm = voxel_mm;
  options.with_color = false;
  return options;
}

double rmsError(const ExtractedSurface& surface, const AnalyticScene& scene) {
  double squares = 0.0;
  for (const Eigen::Vector3f& vertex : surface.mesh.vertices) {
    const double error = scene.distance(vertex.cast<double>());
    squares += error * error;
  }
  return std::sqrt(squares /
                   std::max<double>(1.0, static_cast<double>(surface.mesh.vertices.size())));
}

double farthestError(const ExtractedSurface& surface, const AnalyticScene& scene) {
  double farthest = 0.0;
  for (const Eigen::Vector3f& vertex : surface.mesh.vertices) {
    farthest = std::max(farthest, scene.distance(vertex.cast<double>()));
  }
  return farthest;
}

TEST(TsdfVolume, ObliqueWallGivesTrueDistancesNotThoseAlongTheRay) {
  const RgbdCamera camera = smallCamera();
  AnalyticScene scene;
  scene.planes = {{Eigen::Vector3d(0.7, 0.0, 1.0).normalized(), 330.0}};  // 35 degrees
  TsdfVolume volume(withVoxel(2.0));
  volume.integrate(camera,
                   frameOf(scene.render(camera.depth, RigidTransform::Identity()), 0),
                   RigidTransform::Identity());
  const Plane& wall = scene.planes.front();
  const Eigen::Vector3d on_wall = wall.normal * wall.offset_mm + Eigen::Vector3d(-150, 0, 105);
  for (double depth = -4.0; depth <= 4.0; depth += 0.5) {
    SdfSample sample;
    ASSERT_TRUE(volume.sample((on_wall - depth * wall.normal).cast<float>(), sample)) << depth;
    EXPECT_NEAR(sample.distance_mm, depth, 0.01);
    EXPECT_LT((sample.gradient.cast<double>() + wall.normal).norm(), 0.01);
  }
}

TEST(TsdfVolume, NothingIsKnownWhereNothingWasSeen) {
  const RgbdCamera camera = smallCamera();
  TsdfVolume volume(withVoxel(2.0));
  volume.integrate(camera,
                   frameOf(ball(50).render(camera.depth, RigidTransform::Identity()), 0),
                   RigidTransform::Identity());
  SdfSample sample;
  EXPECT_TRUE(volume.sample({0, 0, 351}, sample));
  EXPECT_FALSE(volume.sample({0, 0, 450}, sample));   // behind
  EXPECT_FALSE(volume.sample({0, 0, 320}, sample));   // before the band
  EXPECT_FALSE(volume.sample({0, 0, 1e6F}, sample));  // outside any index
}

TEST(TsdfVolume, BallSeenFromAllSidesIsClosedAndRight) {
  const RgbdCamera camera = smallCamera();
  const AnalyticScene scene = ball(50);
  TsdfVolume volume(withVoxel(1.0));
  for (const RigidTransform& pose : allAround(350)) {
    volume.integrate(camera, frameOf(scene.render(camera.depth, pose), 0), pose);
  }
  const ExtractedSurface surface = volume.extractSurface(2.0F);
  EXPECT_EQ(countHoles(surface.mesh), 0);
  // A tangent plane is off by x^2 / 2R half a pixel (0.7 mm) from its foot: 0.005 mm, the chord of
  // a cell by 0.003 mm; oblique views stretch the pixel four times.
  EXPECT_LT(rmsError(surface, scene), 0.03);
  EXPECT_LT(farthestError(surface, scene), 0.15);
}

TEST(TsdfVolume, NoiseAveragesOut) {
  const RgbdCamera camera = smallCamera();
  const AnalyticScene scene = ball(50);
  TsdfVolume volume(withVoxel(1.0));
  for (int i = 0; i < 40; ++i) {
    const RigidTransform pose = arcPose(0.01 * (i - 20));
    volume.integrate(
        camera,
        frameOf(withNoise(scene.render(camera.depth, pose), static_cast<std::uint64_t>(i)), i),
        pose);
  }
  const ExtractedSurface surface = volume.extractSurface(10.0F);
  // One frame errs by 0.36 mm; 40 of them, oblique ones included, by 0.06 mm and some.
  EXPECT_LT(rmsError(surface, scene), 0.12);
  double sigma = 0.0;
  for (const float value : surface.sigma_mm) {
    sigma += value;
  }
  sigma /= static_cast<double>(surface.sigma_mm.size());
  EXPECT_GT(sigma, 0.03);
  EXPECT_LT(sigma, 0.15);
}

TEST(TsdfVolume, FewerObservationsThanAskedGiveNoSurface) {
  const RgbdCamera camera = smallCamera();
  const RgbdFrame frame = frameOf(ball(50).render(camera.depth, RigidTransform::Identity()), 0);
  TsdfVolume volume(withVoxel(1.0));
  volume.integrate(camera, frame, RigidTransform::Identity());
  volume.integrate(camera, frame, RigidTransform::Identity());
  EXPECT_TRUE(volume.extractSurface(3.0F).mesh.faces.empty());
  volume.integrate(camera, frame, RigidTransform::Identity());
  volume.integrate(camera, frame, RigidTransform::Identity());
  const ExtractedSurface surface = volume.extractSurface(3.0F);
  EXPECT_GT(surface.mesh.faces.size(), 1000U);
  for (const std::uint16_t observations : surface.observations) {
    EXPECT_EQ(observations, 4);
  }
}

TEST(TsdfVolume, FacesTurnTowardsTheCamera) {
  const RgbdCamera camera = smallCamera();
  TsdfVolume volume(withVoxel(2.0));
  volume.integrate(camera,
                   frameOf(ball(50).render(camera.depth, RigidTransform::Identity()), 0),
                   RigidTransform::Identity());
  const ExtractedSurface surface = volume.extractSurface(0.1F);
  ASSERT_FALSE(surface.mesh.faces.empty());
  for (int i = 0; i < static_cast<int>(surface.mesh.faces.size()); ++i) {
    EXPECT_LT(faceNormal(surface.mesh, i).z(), 0.0);
  }
}

TEST(TsdfVolume, ColoursStandWhereTheCameraSawThem) {
  RgbdCamera camera = smallCamera();
  camera.color_from_depth.translation() = Eigen::Vector3d(25, 0, 0);  // a second eye
  AnalyticScene scene;
  scene.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  RgbdFrame frame = frameOf(scene.render(camera.depth, RigidTransform::Identity()), 0);
  frame.color = ColorImage(camera.color.width, camera.color.height);
  for (int v = 0; v < camera.color.height; ++v) {
    for (int u = 0; u < camera.color.width; ++u) {
      // The wall is red where x < 0 in the depth camera's frame.
      const double x = camera.color.ray(u, v).x() * 400.0 - 25.0;
      frame.color.at(u, v) = x < 0.0 ? Rgb8{200, 10, 10} : Rgb8{10, 10, 200};
    }
  }
  TsdfOptions options = withVoxel(2.0);
  options.with_color = true;
  TsdfVolume volume(options);
  volume.integrate(camera, frame, RigidTransform::Identity());
  const ExtractedSurface surface = volume.extractSurface(0.1F);
  ASSERT_EQ(surface.colors.size(), surface.mesh.vertices.size());
  int checked = 0;
  for (std::size_t i = 0; i < surface.colors.size(); ++i) {
    const float x = surface.mesh.vertices[i].x();
    if (std::abs(x) > 3.0F && std::abs(x) < 120.0F) {  // off the border by a voxel and a pixel
      EXPECT_EQ(surface.colors[i].r, x < 0.0F ? 200 : 10);
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000);
}

TEST(TsdfVolume, SameBitsWithOneThreadAndTwo) {
  const RgbdCamera camera = smallCamera();
  const AnalyticScene scene = bumpyScene();
  const auto fused = [&](int threads) {
    const ThreadLimit limit(threads);
    TsdfVolume volume(withVoxel(2.0));
    for (int i = 0; i < 4; ++i) {
      const RigidTransform pose = arcPose(0.03 * i);
      volume.integrate(camera, frameOf(withNoise(scene.render(camera.depth, pose), 7), i), pose);
    }
    return volume.extractSurface(2.0F);
  };
  const ExtractedSurface one = fused(1);
  const ExtractedSurface two = fused(2);
  ASSERT_EQ(one.mesh.vertices.size(), two.mesh.vertices.size());
  ASSERT_EQ(one.mesh.faces.size(), two.mesh.faces.size());
  EXPECT_GT(one.mesh.faces.size(), 1000U);
  EXPECT_EQ(0,
            std::memcmp(one.mesh.vertices.data(),
                        two.mesh.vertices.data(),
                        one.mesh.vertices.size() * sizeof(Eigen::Vector3f)));
  EXPECT_EQ(
      0,
      std::memcmp(one.sigma_mm.data(), two.sigma_mm.data(), one.sigma_mm.size() * sizeof(float)));
  EXPECT_TRUE(one.mesh.faces == two.mesh.faces);
}

TEST(TsdfVolume, MemoryGrowsWithTheSurfaceNotWithTheSpace) {
  const RgbdCamera camera = smallCamera();
  AnalyticScene near;
  near.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  TsdfVolume volume(withVoxel(1.0));
  const std::size_t empty = volume.memoryBytes();
  volume.integrate(camera,
                   frameOf(near.render(camera.depth, RigidTransform::Identity()), 0),
                   RigidTransform::Identity());
  // 417 x 313 mm of wall in a band 12 mm deep, at most four blocks of 8 mm: 14 bytes a voxel.
  const double voxels = 417.0 * 313.0 * 32.0;
  EXPECT_LT(static_cast<double>(volume.memoryBytes() - empty), 1.3 * 14.0 * voxels);
}

}  // namespace
}  // namespace tarsus
