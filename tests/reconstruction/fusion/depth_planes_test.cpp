#include "reconstruction/fusion/depth_planes.h"

#include "tests/reconstruction/fusion/analytic_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

AnalyticScene tiltedWall() {
  AnalyticScene scene;
  scene.planes = {{Eigen::Vector3d(0.3, -0.4, 1.0).normalized(), 350.0}};
  return scene;
}

TEST(DepthPlanes, WallGivesItsOwnPlaneAtEveryInnerPixel) {
  const Intrinsics camera = smallCamera().depth;
  const AnalyticScene scene = tiltedWall();
  const DepthPlanes planes =
      fitDepthPlanes(camera, scene.render(camera, RigidTransform::Identity()), {});
  EXPECT_EQ(planes.valid_count, (camera.width - 4) * (camera.height - 4));
  const Plane& wall = scene.planes.front();
  for (int v = 2; v < camera.height - 2; v += 7) {
    for (int u = 2; u < camera.width - 2; u += 7) {
      const std::size_t i = planes.index(u, v);
      // Turned towards the camera; 1e-3: float depth of 350 mm has steps of 3e-5 mm.
      EXPECT_LT((planes.normal(i).cast<double>() + wall.normal).norm(), 1e-3);
      EXPECT_NEAR(planes.offset_mm[i], wall.offset_mm, 0.2);
    }
  }
}

TEST(DepthPlanes, QualityIsTheCosineOfIncidence) {
  const Intrinsics camera = smallCamera().depth;
  const AnalyticScene scene = tiltedWall();
  const DepthPlanes planes =
      fitDepthPlanes(camera, scene.render(camera, RigidTransform::Identity()), {});
  const double expected = scene.planes.front().normal.dot(camera.ray(100, 80).normalized());
  EXPECT_NEAR(planes.quality[planes.index(100, 80)], expected, 1e-3);
}

TEST(DepthPlanes, GrazingSurfaceHasNone) {
  const Intrinsics camera = smallCamera().depth;
  AnalyticScene floor;
  floor.planes = {{Eigen::Vector3d::UnitY(), 40.0}};  // seen at 65 to 85 degrees
  const DepthImage depth = floor.render(camera, RigidTransform::Identity());
  const DepthPlanes planes = fitDepthPlanes(camera, depth, {.max_incidence_deg = 75.0});
  EXPECT_GT(planes.valid_count, 1000);
  for (int v = 0; v < camera.height; ++v) {
    const double incidence_cosine = camera.ray(160, v).normalized().y();
    const bool seen = planes.quality[planes.index(160, v)] > 0.0F;
    EXPECT_TRUE(!seen || incidence_cosine > std::cos(76.0 * 3.14159265 / 180.0)) << v;
  }
}

TEST(DepthPlanes, FlyingPixelsAtAnEdgeHaveNone) {
  const Intrinsics camera = smallCamera().depth;
  DepthImage depth(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      // A step of 30 mm whose two middle columns hang in between, as coded light shows it.
      depth.at(u, v) = u < 160 ? 400.0F : u == 160 ? 410.0F : u == 161 ? 420.0F : 430.0F;
    }
  }
  const DepthPlanes planes = fitDepthPlanes(camera, depth, {});
  for (int v = 0; v < camera.height; ++v) {
    EXPECT_EQ(planes.quality[planes.index(160, v)], 0.0F);
    EXPECT_EQ(planes.quality[planes.index(161, v)], 0.0F);
  }
  EXPECT_GT(planes.quality[planes.index(150, 120)], 0.9F);
  EXPECT_GT(planes.quality[planes.index(170, 120)], 0.9F);
}

TEST(DepthPlanes, GapsOfOnePixelAreBridgedOnlyWithinASurface) {
  const Intrinsics camera = smallCamera().depth;
  DepthImage depth(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const bool gap = v % 4 == 3 || u % 5 == 4;  // as registration to colour leaves them
      depth.at(u, v) = gap ? 0.0F : u < 162 ? 400.0F : 500.0F;
    }
  }
  depth.at(162, 100) = 0.0F;
  const DepthPlanes planes = fitDepthPlanes(camera, depth, {});
  EXPECT_EQ(planes.depth_mm[planes.index(104, 100)], 400.0F);
  EXPECT_EQ(planes.depth_mm[planes.index(100, 103)], 400.0F);
  EXPECT_EQ(planes.depth_mm[planes.index(162, 100)], 0.0F);  // lies between 400 and 500 mm
}

TEST(DepthPlanes, DepthOutOfRangeHasNone) {
  const Intrinsics camera = smallCamera().depth;
  DepthImage depth(camera.width, camera.height);
  std::fill(depth.pixels().begin(), depth.pixels().end(), 1600.0F);
  EXPECT_EQ(fitDepthPlanes(camera, depth, {.max_depth_mm = 1500.0}).valid_count, 0);
}

}  // namespace
}  // namespace tarsus
