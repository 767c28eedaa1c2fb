#include "reconstruction/texture/keyframe_view.h"

#include "reconstruction/texture/color_sampling.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

RgbdCamera offsetCamera() {
  RgbdCamera camera = smallCamera();
  camera.color = {
      .width = 400, .height = 300, .fx_px = 390, .fy_px = 385, .cx_px = 190, .cy_px = 155};
  camera.color_from_depth.translation() = Eigen::Vector3d(-25.0, 3.0, 1.0);
  camera.color_from_depth.linear() =
      Eigen::AngleAxisd(0.15, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return camera;
}

/// A picture whose red tells the column and whose green tells the row: half a level a pixel.
ColorImage ruler(const Intrinsics& camera) {
  ColorImage image(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      image.at(u, v) = {static_cast<std::uint8_t>(u / 2), static_cast<std::uint8_t>(v / 2), 100};
    }
  }
  return image;
}

/// The keyframe of a bare plane seen from a place, its depth 300 mm or so and exact.
Keyframe planeKeyframe(const RgbdCamera& camera, const RigidTransform& scan_from_camera) {
  Keyframe keyframe;
  keyframe.scan_from_camera = scan_from_camera;
  keyframe.frame.color = ruler(camera.color);
  keyframe.frame.depth = DepthImage(camera.depth.width, camera.depth.height);
  for (int v = 0; v < camera.depth.height; ++v) {
    for (int u = 0; u < camera.depth.width; ++u) {
      const double along = (scan_from_camera.linear() * camera.depth.ray(u, v)).z();
      keyframe.frame.depth.at(u, v) =
          static_cast<float>(-scan_from_camera.translation().z() / along);
    }
  }
  return keyframe;
}

KeyframeView viewOf(const TriangleMesh& mesh,
                    const RgbdCamera& camera,
                    const Keyframe& keyframe,
                    const std::optional<PicturePlacement>& placement = {}) {
  std::vector<PicturePlacement> placements = placementsByPose(camera, {&keyframe, 1});
  if (placement) {
    placements[0] = *placement;
  }
  auto views = renderViews(mesh, camera, {&keyframe, 1}, placements, {});
  EXPECT_TRUE(views.has_value());
  return std::move(views->front());
}

const TriangleMesh& plane() {
  static const TriangleMesh kPlane = planeSurface(60.0, 4.0).mesh;
  return kPlane;
}

RigidTransform overhead() { return lookAt({20, -15, 300}, {5, 5, 0}); }

TEST(PlacementsByPose, PutTheColourCameraBesideTheDepthCamera) {
  const RgbdCamera camera = offsetCamera();
  std::vector<Keyframe> keyframes(2);
  keyframes[0].scan_from_camera = overhead();
  keyframes[1].scan_from_camera = lookAt({0, 80, 250}, {0, 0, 0});
  const std::vector<PicturePlacement> placements = placementsByPose(camera, keyframes);
  ASSERT_EQ(placements.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector3d p_depth(10, 20, 280);
    const Eigen::Vector3d p_scan = keyframes[k].scan_from_camera * p_depth;
    EXPECT_LT((placements[k].color_from_scan * p_scan - camera.color_from_depth * p_depth).norm(),
              1e-9);
    EXPECT_TRUE(placements[k].warp.empty());
  }
}

TEST(KeyframeView, SeesAVertexWhereThePinholeDoes) {
  const RgbdCamera camera = offsetCamera();
  const Keyframe keyframe = planeKeyframe(camera, overhead());
  const KeyframeView view = viewOf(plane(), camera, keyframe);
  for (const float x : {-30.0F, 0.0F, 25.0F}) {
    const Eigen::Vector3f p(x, 0.5F * x + 3.0F, 0.0F);
    const Eigen::Vector3d in_color =
        camera.color_from_depth * overhead().inverse() * p.cast<double>();
    const Eigen::Vector2d place = camera.color.project(in_color);
    const auto seen = view.observe(p, kUp);
    ASSERT_TRUE(seen.has_value());
    EXPECT_NEAR(seen->u, place.x(), 1e-3);
    EXPECT_NEAR(seen->v, place.y(), 1e-3);
    EXPECT_NEAR(seen->depth_mm, in_color.z(), 1e-3);
    EXPECT_NEAR(view.footprint_mm(*seen), in_color.z() / 387.5, 1e-4);
    // The ruler's steps of one level are two pixels wide.
    EXPECT_NEAR(view.color(*seen).x(), (place.x() - 0.5) / 2.0, 0.51);
    EXPECT_NEAR(view.sharpColor(*seen).y(), (place.y() - 0.5) / 2.0, 0.6);
  }
}

TEST(KeyframeView, WeighsByAngleAndDistance) {
  const RgbdCamera camera = smallCamera();
  const Keyframe keyframe = planeKeyframe(camera, lookAt({0, 0, 300}, {0, 0, 0}));
  const KeyframeView view = viewOf(plane(), camera, keyframe);
  const auto straight = view.observe({0, 0, 0}, kUp);
  const float angle = 50.0F * std::numbers::pi_v<float> / 180.0F;
  const auto tilted = view.observe({0, 0, 0}, {std::sin(angle), 0.0F, std::cos(angle)});
  ASSERT_TRUE(straight && tilted);
  EXPECT_NEAR(tilted->weight / straight->weight, std::cos(angle) * std::cos(angle), 1e-4);
  EXPECT_EQ(straight->trust, 1.0F);
  const Keyframe far_keyframe = planeKeyframe(camera, lookAt({0, 0, 450}, {0, 0, 0}));
  const auto far_away = viewOf(plane(), camera, far_keyframe).observe({0, 0, 0}, kUp);
  ASSERT_TRUE(far_away.has_value());
  EXPECT_NEAR(far_away->weight / straight->weight, 300.0 * 300.0 / (450.0 * 450.0), 1e-4);
  // 70 degrees are the limit.
  const auto normalAt = [](float degrees) {
    const float turn = degrees * std::numbers::pi_v<float> / 180.0F;
    return Eigen::Vector3f(std::sin(turn), 0.0F, std::cos(turn));
  };
  EXPECT_TRUE(view.observe({0, 0, 0}, normalAt(69.0F)).has_value());
  EXPECT_FALSE(view.observe({0, 0, 0}, normalAt(71.0F)).has_value());
  EXPECT_FALSE(view.observe({0, 0, 0}, -kUp).has_value());
}

TEST(KeyframeView, PlacementRulesNotTheKeyframesPose) {
  const RgbdCamera camera = smallCamera();
  const Keyframe keyframe = planeKeyframe(camera, overhead());
  PicturePlacement moved = placementsByPose(camera, {&keyframe, 1}).front();
  moved.color_from_scan.pretranslate(Eigen::Vector3d(3.0, -2.0, 0.0));
  const auto before = viewOf(plane(), camera, keyframe).observe({5, 5, 0}, kUp);
  const KeyframeView view = viewOf(plane(), camera, keyframe, moved);
  const auto after = view.observe({5, 5, 0}, kUp);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->u - before->u, 3.0 * 300.0 / before->depth_mm, 1e-3);
  EXPECT_NEAR(after->v - before->v, -2.0 * 300.0 / before->depth_mm, 1e-3);
  EXPECT_TRUE(view.colorFromScan().isApprox(moved.color_from_scan.cast<float>(), 1e-6F));
}

TEST(KeyframeView, TakesColoursWhereTheWarpSays) {
  const RgbdCamera camera = smallCamera();
  const Keyframe keyframe = planeKeyframe(camera, overhead());
  PicturePlacement bent = placementsByPose(camera, {&keyframe, 1}).front();
  bent.warp = ControlLattice(camera.color.width, camera.color.height, 20);
  for (std::size_t i = 0; i < bent.warp.offsets_px().size(); ++i) {
    bent.warp.offsets_px()[i] = {8.0F, -0.2F * static_cast<float>(i % 20)};
  }
  const KeyframeView straight = viewOf(plane(), camera, keyframe);
  const KeyframeView view = viewOf(plane(), camera, keyframe, bent);
  for (const float x : {-30.0F, 5.0F, 40.0F}) {
    const auto before = straight.observe({x, 5, 0}, kUp);
    const auto after = view.observe({x, 5, 0}, kUp);
    ASSERT_TRUE(before && after);
    EXPECT_NEAR(after->u, before->u + 8.0F, 1e-3);
    EXPECT_NEAR(after->v, before->v - 0.2F * before->u * 19.0F / 319.0F, 1e-3);
    EXPECT_NEAR(view.color(*after).x() - straight.color(*before).x(), 4.0, 0.6);
    // The warp moves colours, not what is seen from where.
    EXPECT_EQ(after->depth_mm, before->depth_mm);
    EXPECT_EQ(after->trust, before->trust);
    EXPECT_EQ(after->weight, before->weight);
  }
}

TEST(KeyframeView, IsEmptyWhereTheWarpLeavesThePicture) {
  const RgbdCamera camera = smallCamera();
  const TriangleMesh wide = planeSurface(200.0, 10.0).mesh;
  const Keyframe keyframe = planeKeyframe(camera, lookAt({0, 0, 300}, {0, 0, 0}));
  const KeyframeView straight = viewOf(wide, camera, keyframe);
  PicturePlacement bent = placementsByPose(camera, {&keyframe, 1}).front();
  bent.warp = ControlLattice(camera.color.width, camera.color.height, 20);
  for (Eigen::Vector2f& offset : bent.warp.offsets_px()) {
    offset = {6.0F, 0.0F};
  }
  const KeyframeView view = viewOf(wide, camera, keyframe, bent);
  int lost = 0;
  for (float x = -158.0F; x < 158.0F; x += 1.0F) {
    const auto before = straight.observe({x, 0, 0}, kUp);
    const auto after = view.observe({x, 0, 0}, kUp);
    if (!before) {
      EXPECT_FALSE(after.has_value());
      continue;
    }
    const bool inside = before->u + 6.0F < 318.99F;
    EXPECT_EQ(after.has_value(), inside) << before->u;
    lost += inside ? 0 : 1;
  }
  EXPECT_GT(lost, 2);
  EXPECT_LT(lost, 8);
}

TEST(KeyframeView, SeesNothingBehindTheModelsFirstSurface) {
  const RgbdCamera camera = smallCamera();
  ExtractedSurface surface = planeSurface(60.0, 2.0);
  appendBall(surface, {.center_mm = {0, 0, 30}, .radius_mm = 15.0}, 24);
  Keyframe keyframe = planeKeyframe(camera, lookAt({0, 0, 300}, {0, 0, 0}));
  keyframe.frame.depth = DepthImage();  // none: the model alone decides
  const KeyframeView view = viewOf(surface.mesh, camera, keyframe);
  EXPECT_TRUE(view.observe({0, 0, 45}, kUp).has_value());
  EXPECT_FALSE(view.observe({0, 0, 0}, kUp).has_value());
  EXPECT_TRUE(view.observe({45, 0, 0}, kUp).has_value());
}

TEST(KeyframeView, SeesNothingBehindWhatTheSensorMeasured) {
  // The colour camera looks past by 25 mm and 9 degrees; the depth is asked in its own camera.
  const RgbdCamera camera = offsetCamera();
  Keyframe keyframe = planeKeyframe(camera, overhead());
  const Eigen::Vector3f hidden(10, 0, 0);
  const Eigen::Vector2d pixel = camera.depth.project(overhead().inverse() * hidden.cast<double>());
  const auto depthLess = [&](float nearer_mm) {
    Keyframe result = keyframe;
    for (int dv = -3; dv <= 3; ++dv) {
      for (int du = -3; du <= 3; ++du) {
        result.frame.depth.at(static_cast<int>(std::lround(pixel.x())) + du,
                              static_cast<int>(std::lround(pixel.y())) + dv) -= nearer_mm;
      }
    }
    return result;
  };
  const Keyframe occluded = depthLess(12.0F);
  const KeyframeView view = viewOf(plane(), camera, occluded);
  EXPECT_FALSE(view.observe(hidden, kUp).has_value());
  EXPECT_TRUE(view.observe({20, 0, 0}, kUp).has_value());
  const Keyframe noisy = depthLess(4.0F);
  EXPECT_TRUE(viewOf(plane(), camera, noisy).observe(hidden, kUp).has_value());
  Keyframe holes = keyframe;
  std::ranges::fill(holes.frame.depth.pixels(), 0.0F);
  EXPECT_TRUE(viewOf(plane(), camera, holes).observe(hidden, kUp).has_value());
}

TEST(KeyframeView, SeesNothingBehindTheCamera) {
  const Keyframe keyframe = planeKeyframe(smallCamera(), overhead());
  const KeyframeView view = viewOf(plane(), smallCamera(), keyframe);
  EXPECT_FALSE(view.observe({20, -15, 320}, kUp).has_value());
  EXPECT_FALSE(view.observe({20, -15, 299}, kUp).has_value());
}

TEST(RenderViews, RefusesPicturesOfAnotherSize) {
  const std::vector<Keyframe> keyframes{planeKeyframe(smallCamera(), overhead())};
  RgbdCamera other = smallCamera();
  other.color.height = 480;
  const auto views = renderViews(plane(), other, keyframes, {});
  ASSERT_FALSE(views.has_value());
  EXPECT_EQ(views.error().code, ErrorCode::CameraFactsInvalid);
}

}  // namespace
}  // namespace tarsus
