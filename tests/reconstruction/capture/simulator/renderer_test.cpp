#include "reconstruction/capture/simulator/renderer.h"

#include "reconstruction/capture/simulator/camera_path.h"
#include "tests/reconstruction/capture/simulator/planes.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

TEST(Renderer, DepthOfATiltedPlaneIsExact) {
  constexpr double kZMm = 400.0;
  constexpr double kTilt = 0.6;
  const Renderer renderer(planeScene(kZMm, kTilt));
  const Intrinsics camera = simulatedCamera({}).depth;
  const IdealView view = renderer.render(camera, RigidTransform::Identity());
  const Eigen::Vector3d normal(std::sin(kTilt), 0.0, -std::cos(kTilt));
  for (int v = 5; v < camera.height; v += 37) {
    for (int u = 5; u < camera.width; u += 41) {
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double z_mm = -kZMm * std::cos(kTilt) / normal.dot(ray);
      // Vertices in single precision at 900 mm: 0.00006 mm, seen at a slant.
      ASSERT_NEAR(view.depth_mm.at(u, v), z_mm, 0.0005);
      ASSERT_NEAR(view.incidence_cos.at(u, v), std::abs(normal.dot(ray)) / ray.norm(), 1e-5);
    }
  }
}

TEST(Renderer, SeesFromTheGivenPose) {
  const Renderer renderer(planeScene(500.0, 0.0));
  RigidTransform pose = RigidTransform::Identity();
  pose.translation() = Eigen::Vector3d(20, -10, 130);
  const Intrinsics camera = simulatedCamera({}).depth;
  EXPECT_NEAR(renderer.render(camera, pose).depth_mm.at(320, 240), 370.0, 0.0005);
}

}  // namespace
}  // namespace tarsus
