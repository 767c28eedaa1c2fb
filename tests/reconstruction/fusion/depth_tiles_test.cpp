#include "reconstruction/fusion/depth_tiles.h"

#include "tests/reconstruction/fusion/perturbed_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tarsus {
namespace {

constexpr float kBand_mm = 6.0F;

class Dice {
 public:
  explicit Dice(unsigned seed) : generator_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_()) * 0x1.0p-32;
  }
  /// In the cube [-1, 1]^3.
  Eigen::Vector3d direction() {
    const double x = between(-1.0, 1.0);
    const double y = between(-1.0, 1.0);
    return {x, y, between(-1.0, 1.0)};
  }

 private:
  std::mt19937 generator_;
};

/// Balls and walls at any place and slope, seen by a camera at the origin.
AnalyticScene randomScene(Dice& dice) {
  AnalyticScene scene;
  for (int i = 0; i < 4; ++i) {
    scene.spheres.push_back(
        {{dice.between(-150.0, 150.0), dice.between(-120.0, 120.0), dice.between(250.0, 600.0)},
         dice.between(10.0, 80.0)});
  }
  const Eigen::Vector3d slope(dice.between(-2.5, 2.5), dice.between(-2.5, 2.5), 1.0);
  scene.planes = {{slope.normalized(), dice.between(150.0, 500.0)}};
  return scene;
}

/// Whether the frame says something about a point: as the volume's update asks it.
bool concerns(const DepthPlanes& planes, const Eigen::Vector3f& p) {
  const Intrinsics& k = planes.intrinsics;
  if (p.z() <= 1.0F) {
    return false;
  }
  const Eigen::Vector2d pixel = k.project(p.cast<double>()) + Eigen::Vector2d(0.5, 0.5);
  if (pixel.minCoeff() < 0.0 || pixel.x() >= k.width || pixel.y() >= k.height) {
    return false;
  }
  const std::size_t i = planes.index(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  const float distance = planes.normal(i).dot(p) + planes.offset_mm[i];
  return planes.quality[i] > 0.0F && std::abs(distance) <= kBand_mm;
}

TEST(DepthTiles, NoBallThatTheFrameConcernsIsRejected) {
  Dice dice(11);
  int concerned = 0;
  for (int round = 0; round < 200; ++round) {
    const DepthPlanes planes =
        fitDepthPlanes(smallCamera().depth,
                       randomScene(dice).render(smallCamera().depth, RigidTransform::Identity()),
                       {.max_depth_ratio = 0.0});
    const DepthTiles tiles(planes, kBand_mm);
    for (int n = 0; n < 20'000; ++n) {
      // Points near what was measured, so that many lie within the band.
      const int u = static_cast<int>(dice.between(0.0, 319.999));
      const int v = static_cast<int>(dice.between(0.0, 239.999));
      const std::size_t i = planes.index(u, v);
      if (planes.quality[i] <= 0.0F) {
        continue;
      }
      const double z = planes.depth_mm[i] + dice.between(-25.0, 25.0);
      const Eigen::Vector3f p = (planes.intrinsics.ray(u, v) * z + dice.direction()).cast<float>();
      if (!concerns(planes, p)) {
        continue;
      }
      ++concerned;
      const double radius = round % 2 == 0 ? dice.between(0.01, 0.3) : dice.between(0.3, 20.0);
      const Eigen::Vector3d to_center = dice.direction().normalized() * radius * 0.999;
      const Eigen::Vector3f center = p + to_center.cast<float>();
      ASSERT_TRUE(tiles.mayConcern(center, static_cast<float>(radius)))
          << "radius " << radius << " at " << center.transpose() << ", point " << p.transpose()
          << ", quality " << planes.quality[i];
    }
  }
  EXPECT_GT(concerned, 200'000);
}

TEST(DepthTiles, MostOfSpaceIsToldAtAGlance) {
  AnalyticScene wall;
  wall.planes = {{Eigen::Vector3d::UnitZ(), 400.0}};
  const DepthPlanes planes = fitDepthPlanes(
      smallCamera().depth, wall.render(smallCamera().depth, RigidTransform::Identity()), {});
  const DepthTiles tiles(planes, kBand_mm);
  EXPECT_TRUE(tiles.mayConcern({0, 0, 400}, 7.0F));
  EXPECT_TRUE(tiles.mayConcern({0, 0, 412}, 7.0F));
  EXPECT_FALSE(tiles.mayConcern({0, 0, 420}, 7.0F));    // behind
  EXPECT_FALSE(tiles.mayConcern({0, 0, 380}, 7.0F));    // before
  EXPECT_FALSE(tiles.mayConcern({300, 0, 400}, 7.0F));  // beside the picture
  EXPECT_FALSE(tiles.mayConcern({0, 0, -400}, 7.0F));   // behind the camera
}

TEST(DepthTiles, AFrameWithoutDepthConcernsNothing) {
  const DepthPlanes planes = fitDepthPlanes(smallCamera().depth, DepthImage(320, 240), {});
  EXPECT_FALSE(DepthTiles(planes, kBand_mm).mayConcern({0, 0, 400}, 50.0F));
}

}  // namespace
}  // namespace tarsus
