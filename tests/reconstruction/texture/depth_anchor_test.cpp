#include "reconstruction/texture/depth_anchor.h"

#include "reconstruction/scene/mesh_index.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

/// How far poses are off.
constexpr double kShift_mm = 2.0;
constexpr double kTurn_rad = 0.5 * std::numbers::pi / 180.0;

RigidTransform viewpoint() { return lookAt({60, 40, 280}, {0, 0, 10}); }

/// Balls of three sizes on a plane hold all six directions; one ball would leave the turn about
/// the plane's normal through its centre.
const TriangleMesh& bumpyMesh() {
  static const TriangleMesh kMesh = [] {
    ExtractedSurface surface = planeSurface(90.0, 5.0);
    appendBall(surface, {.center_mm = {-35, 20, 5}, .radius_mm = 30.0}, 30);
    appendBall(surface, {.center_mm = {40, 30, 8}, .radius_mm = 22.0}, 30);
    appendBall(surface, {.center_mm = {10, -40, 4}, .radius_mm = 26.0}, 30);
    return surface.mesh;
  }();
  return kMesh;
}

/// Depth of the mesh itself by rays: exact but for rounding.
DepthImage depthOf(const TriangleMesh& mesh,
                   const Intrinsics& camera,
                   const RigidTransform& scan_from_camera) {
  const MeshIndex index(mesh);
  DepthImage depth(camera.width, camera.height);
  const Eigen::Vector3f origin = scan_from_camera.translation().cast<float>();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3f ray = (scan_from_camera.linear() * camera.ray(u, v)).cast<float>();
      const MeshIndex::RayHit hit = index.castRay(origin, ray);
      depth.at(u, v) = hit.face >= 0 ? hit.distance : 0.0F;
    }
  }
  return depth;
}

const DepthImage& exactDepth() {
  static const DepthImage kDepth = depthOf(bumpyMesh(), smallCamera().depth, viewpoint());
  return kDepth;
}

/// Even in (0, 1), from a counter.
double even(std::uint32_t counter) {
  std::uint32_t x = counter * 2654435761U + 0x9e3779b9U;
  x = (x ^ (x >> 16U)) * 0x85ebca6bU;
  x = (x ^ (x >> 13U)) * 0xc2b2ae35U;
  return (static_cast<double>(x ^ (x >> 16U)) + 0.5) * 0x1.0p-32;
}

/// The motion number i: by so much in all directions, about the middle of the scene.
RigidTransform motionOff(int i) {
  const auto direction = [](double phase) {
    return Eigen::Vector3d(std::sin(phase), std::cos(1.7 * phase), std::sin(2.3 * phase + 1.0))
        .normalized();
  };
  MotionVector off;
  off << kMotionLever_mm * kTurn_rad * direction(0.9 * i + 0.3), kShift_mm * direction(1.3 * i);
  return motionOf(off, {0, 0, 10});
}

Keyframe keyframeOf(const DepthImage& depth, const RigidTransform& scan_from_camera) {
  Keyframe keyframe;
  keyframe.frame.depth = depth;
  keyframe.scan_from_camera = scan_from_camera;
  return keyframe;
}

/// How far apart two poses put what the camera sees [mm], at most.
double greatestShift(const RigidTransform& a_from_scan, const RigidTransform& b_from_scan) {
  double greatest = 0.0;
  for (const double x : {-60.0, 60.0}) {
    for (const double y : {-60.0, 60.0}) {
      for (const double z : {0.0, 30.0}) {
        const Eigen::Vector3d p(x, y, z);
        greatest = std::max(greatest, (a_from_scan * p - b_from_scan * p).norm());
      }
    }
  }
  return greatest;
}

TEST(MotionBetween, InvertsMotionOf) {
  const Eigen::Vector3d center(10, -20, 300);
  const RigidTransform from = viewpoint().inverse();
  for (int i = 0; i < 8; ++i) {
    MotionVector motion;
    motion << 12.0 * std::sin(i), 9.0 * std::cos(2.0 * i), -7.0 + i, 3.0 - i, 0.5 * i, 1.0;
    const RigidTransform to = motionOf(motion, center) * from;
    EXPECT_LT((motionBetween(from, to, center) - motion).norm(), 1e-9);
  }
  EXPECT_LT(motionBetween(from, from, center).norm(), 1e-9);
}

TEST(DepthAnchor, BringsAPoseBackExactly) {
  for (int i = 0; i < 4; ++i) {
    const RigidTransform wrong = motionOff(i) * viewpoint();
    ASSERT_GT(greatestShift(wrong.inverse(), viewpoint().inverse()), 1.5);
    const auto anchor = anchorToDepth(bumpyMesh(), smallCamera(), keyframeOf(exactDepth(), wrong));
    ASSERT_TRUE(anchor.has_value());
    EXPECT_LT(greatestShift(anchor->color_from_scan, viewpoint().inverse()), 0.02) << i;
  }
}

TEST(DepthAnchor, StaysWithinWhatNoiseGives) {
  constexpr double kNoise_mm = 0.4;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    DepthImage noisy = exactDepth();
    int measured = 0;
    for (std::uint32_t i = 0; i < noisy.pixels().size(); ++i) {
      if (noisy.pixels()[i] > 0.0F) {
        noisy.pixels()[i] += static_cast<float>(kNoise_mm * seededNoise(seed * 1'000'003U + i));
        ++measured;
      }
    }
    const RigidTransform wrong = motionOff(static_cast<int>(seed)) * viewpoint();
    const auto anchor = anchorToDepth(bumpyMesh(), smallCamera(), keyframeOf(noisy, wrong));
    ASSERT_TRUE(anchor.has_value());
    // Least squares leave d^T S d = 6 noise^2 / pixels in the mean, chi-squared of 6 degrees; 4 in
    // 100 000 exceed 5 times that. At least every fourth pixel in each direction must be used.
    const MotionVector off =
        motionBetween(anchor->color_from_scan, viewpoint().inverse(), anchor->center);
    const double squared_mm2 = off.dot(anchor->stiffness * off);
    EXPECT_LT(squared_mm2, 5.0 * 6.0 * kNoise_mm * kNoise_mm / (measured / 16.0)) << seed;
    EXPECT_LT(greatestShift(anchor->color_from_scan, viewpoint().inverse()), 0.25) << seed;
  }
}

/// Mean square of how far a small motion takes what the camera sees along its normals, by rays.
double meanSquareAlongNormals(const MotionVector& motion, const Eigen::Vector3d& center) {
  const MeshIndex index(bumpyMesh());
  const RigidTransform moved = motionOf(motion, center);
  const RigidTransform pose = viewpoint();
  double sum = 0.0;
  int count = 0;
  for (int v = 0; v < 240; v += 3) {
    for (int u = 0; u < 320; u += 3) {
      const Eigen::Vector3d ray = smallCamera().depth.ray(u, v);
      const MeshIndex::RayHit hit =
          index.castRay(pose.translation().cast<float>(), (pose.linear() * ray).cast<float>());
      if (hit.face < 0) {
        continue;
      }
      const Eigen::Vector3d normal = pose.linear().transpose() * faceNormal(bumpyMesh(), hit.face);
      const Eigen::Vector3d p = static_cast<double>(hit.distance) * ray;
      if (-normal.dot(ray.normalized()) > 0.34) {  // 70 degrees, as for colours
        const double along = normal.dot(moved * p - p);
        sum += along * along;
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(DepthAnchor, TellsHowFirmlyTheShapeHolds) {
  const auto anchor =
      anchorToDepth(bumpyMesh(), smallCamera(), keyframeOf(exactDepth(), viewpoint()));
  ASSERT_TRUE(anchor.has_value());
  EXPECT_LT((anchor->stiffness - anchor->stiffness.transpose()).norm(), 1e-9);
  // Shading normals against those of the faces, and every third pixel: a few per cent.
  for (int i = 0; i < 6; ++i) {
    const MotionVector motion = 0.1 * MotionVector::Unit(i);
    const double wanted = meanSquareAlongNormals(motion, anchor->center);
    EXPECT_GT(wanted, 1e-5);  // the scene holds it
    EXPECT_NEAR(motion.dot(anchor->stiffness * motion) / wanted, 1.0, 0.1) << i;
  }
}

TEST(DepthAnchor, LeavesFreeDirectionsOfAPlaneAsGiven) {
  const TriangleMesh plane = planeSurface(400.0, 20.0).mesh;
  const RigidTransform camera = lookAt({0, 0, 300}, {0, 0, 0});
  const DepthImage depth = depthOf(plane, smallCamera().depth, camera);
  // Off by 2 mm within the plane, 2 mm along its normal, and half a degree each about the normal
  // and about an axis within the plane.
  RigidTransform free = RigidTransform::Identity();
  free.linear() = Eigen::AngleAxisd(kTurn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  free.translation() = Eigen::Vector3d(1.6, -1.2, 0.0);
  RigidTransform held = RigidTransform::Identity();
  held.linear() = Eigen::AngleAxisd(kTurn_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  held.translation() = Eigen::Vector3d(0.0, 0.0, 2.0);
  const auto anchor = anchorToDepth(plane, smallCamera(), keyframeOf(depth, free * held * camera));
  ASSERT_TRUE(anchor.has_value());
  // What the plane does not hold stays; turning back by half a degree about a centre some mm off
  // the plane moves along it by a hundredth of that.
  EXPECT_LT(greatestShift(anchor->color_from_scan, (free * camera).inverse()), 0.05);
}

TEST(DepthAnchor, BearsHolesAndOutliers) {
  DepthImage depth = exactDepth();
  for (std::uint32_t i = 0; i < depth.pixels().size(); ++i) {
    const double fate = even(7U * i + 1U);
    if (fate < 0.3) {
      depth.pixels()[i] = 0.0F;
    } else if (fate < 0.4) {  // one pixel in seven of those left
      depth.pixels()[i] += static_cast<float>(150.0 * even(7U * i + 2U) - 100.0);
    }
  }
  const auto anchor =
      anchorToDepth(bumpyMesh(), smallCamera(), keyframeOf(depth, motionOff(2) * viewpoint()));
  ASSERT_TRUE(anchor.has_value());
  // Outliers within the last kernel of 2 mm are 1 in 40 of the 10 %: 20 or so pixels of noise.
  EXPECT_LT(greatestShift(anchor->color_from_scan, viewpoint().inverse()), 0.05);
}

TEST(DepthAnchor, BearsAThingThatTheModelLacks) {
  DepthImage depth = exactDepth();
  for (int v = 60; v < 130; ++v) {  // a hand, 30 mm above the surface
    for (int u = 100; u < 180; ++u) {
      depth.at(u, v) -= 30.0F;
    }
  }
  const auto anchor =
      anchorToDepth(bumpyMesh(), smallCamera(), keyframeOf(depth, motionOff(1) * viewpoint()));
  ASSERT_TRUE(anchor.has_value());
  EXPECT_LT(greatestShift(anchor->color_from_scan, viewpoint().inverse()), 0.05);
}

TEST(DepthAnchor, GivesThePlaceOfAnOffsetColourCamera) {
  RgbdCamera camera = smallCamera();
  camera.color = {
      .width = 400, .height = 300, .fx_px = 390, .fy_px = 385, .cx_px = 190, .cy_px = 155};
  camera.color_from_depth.translation() = Eigen::Vector3d(-25.0, 3.0, 1.0);
  camera.color_from_depth.linear() =
      Eigen::AngleAxisd(0.15, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const RigidTransform truth = camera.color_from_depth * viewpoint().inverse();
  for (int i = 0; i < 3; ++i) {
    const auto anchor =
        anchorToDepth(bumpyMesh(), camera, keyframeOf(exactDepth(), motionOff(i) * viewpoint()));
    ASSERT_TRUE(anchor.has_value());
    EXPECT_LT(greatestShift(anchor->color_from_scan, truth), 0.02);
    // The centre lies on what the depth shows, in the colour camera.
    const Eigen::Vector3d center_scan = truth.inverse() * anchor->center;
    EXPECT_LT(center_scan.head<2>().norm(), 30.0);
    EXPECT_NEAR(center_scan.z(), 10.0, 10.0);
  }
}

TEST(DepthAnchor, IsEmptyWithoutEnoughDepthOnTheModel) {
  const auto anchored = [](const DepthImage& depth, const TriangleMesh& mesh) {
    return anchorToDepth(mesh, smallCamera(), keyframeOf(depth, viewpoint())).has_value();
  };
  ASSERT_TRUE(anchored(exactDepth(), bumpyMesh()));
  EXPECT_FALSE(anchored(DepthImage(), bumpyMesh()));
  EXPECT_FALSE(anchored(DepthImage(320, 240), bumpyMesh()));  // nothing measured
  EXPECT_FALSE(anchored(DepthImage(160, 120), bumpyMesh()));
  DepthImage patch(320, 240);  // 20 x 20 pixels
  for (int v = 110; v < 130; ++v) {
    for (int u = 150; u < 170; ++u) {
      patch.at(u, v) = exactDepth().at(u, v);
    }
  }
  EXPECT_FALSE(anchored(patch, bumpyMesh()));
  DepthImage far = exactDepth();  // nowhere near the model
  for (float& z : far.pixels()) {
    z += 200.0F;
  }
  EXPECT_FALSE(anchored(far, bumpyMesh()));
  EXPECT_FALSE(anchored(exactDepth(), TriangleMesh()));
  TriangleMesh bare = bumpyMesh();
  bare.normals.clear();
  EXPECT_FALSE(anchored(exactDepth(), bare));
}

}  // namespace
}  // namespace tarsus
