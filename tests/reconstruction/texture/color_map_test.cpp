#include "reconstruction/texture/color_map.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/keyframe_view.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace tarsus {
namespace {

constexpr double kHalf_mm = 50.0;
constexpr double kInner_mm = 40.0;  // away from the plane's rim, where background bleeds in

Eigen::Vector3d toVector(Rgb8 c) {
  return {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
}

/// Vertices a pixel apart, as many tests as can do with: four times as fast.
const ColorMapOptions kCoarse{.vertex_spacing_px = 1.0};

/// Poses are true here: aligning has tests of its own.
TexturedMesh colored(const ExtractedSurface& surface,
                     const RgbdCamera& camera,
                     const std::vector<Keyframe>& keyframes,
                     ColorMapOptions options = kCoarse) {
  options.align = false;
  Expected<ColoredSurface> colored = colorSurface(surface, camera, keyframes, options, Job{});
  EXPECT_TRUE(colored.has_value());
  return colored ? std::move(colored->model) : TexturedMesh();
}

/// Eight good views of the plane alone, taken once for all tests that need nothing else.
const std::vector<Keyframe>& plainRing() {
  static const std::vector<Keyframe> kRing = ringOfKeyframes({}, smallCamera(), 8);
  return kRing;
}

bool isInnerPlane(const Eigen::Vector3f& p) {
  return p.z() == 0.0F && std::abs(p.x()) < kInner_mm && std::abs(p.y()) < kInner_mm;
}

/// PSNR of seen vertices on the inner plane against the texture [dB], one gain per channel fitted.
double planePsnr(const TexturedMesh& model, const TexturedScene& scene) {
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  const auto eachInner = [&](const auto& use) {
    for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
      const Eigen::Vector3f& p = model.mesh.vertices[i];
      if (isInnerPlane(p) && model.unseen[i] == 0) {
        use(toVector(model.colors[i]),
            scene.planeColor(static_cast<double>(p.x()), static_cast<double>(p.y())));
      }
    }
  };
  eachInner([&](const Eigen::Vector3d& found, const Eigen::Vector3d& truth) {
    products += found.cwiseProduct(truth);
    squares += found.cwiseProduct(found);
  });
  const Eigen::Vector3d gain = products.cwiseQuotient(squares);
  double sum = 0.0;
  double count = 0.0;
  eachInner([&](const Eigen::Vector3d& found, const Eigen::Vector3d& truth) {
    sum += (found.cwiseProduct(gain) - truth).squaredNorm();
    count += 3.0;
  });
  return 10.0 * std::log10(255.0 * 255.0 * count / sum);
}

double unseenShare(const TexturedMesh& model) {
  double sum = 0.0;
  for (const std::uint8_t unseen : model.unseen) {
    sum += unseen;
  }
  return sum / static_cast<double>(model.unseen.size());
}

TEST(ColorSurface, RecoversATexturedPlane) {
  const TexturedScene scene;
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  const std::vector<Keyframe> keyframes = plainRing();
  const TexturedMesh model = colored(surface, smallCamera(), keyframes, {});
  EXPECT_EQ(unseenShare(model), 0.0);
  // A pixel covers 1 mm of a 10 mm wave of +-40 levels: box and bilinear filter take 3 % of the
  // amplitude each, some 2 levels RMS or 43 dB; 8-bit rounding adds little.
  const double psnr_db = planePsnr(model, scene);
  std::printf("PSNR, plane without noise: %.1f dB\n", psnr_db);
  EXPECT_GT(psnr_db, 38.0);
}

TEST(ColorSurface, AveragesNoiseAway) {
  const TexturedScene scene;
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  const std::vector<Keyframe> keyframes = ringOfKeyframes(scene, smallCamera(), 8, 8.0);
  const auto dbOf = [&](const ColorMapOptions& options) {
    return planePsnr(colored(surface, smallCamera(), keyframes, options), scene);
  };
  const double one_db = dbOf({.best_views = 1, .fit = {.sweeps = 0}});
  const double six_db = dbOf({.fit = {.sweeps = 0}});
  const double fitted_db = dbOf({});
  std::printf("PSNR, noise of 8 levels: %.1f dB from one view, %.1f dB from six, %.1f dB fitted\n",
              one_db,
              six_db,
              fitted_db);
  // 8 levels are 30 dB; the mean of six views, unevenly weighted, must gain 4 dB of the ideal 7.8.
  EXPECT_GT(six_db, one_db + 3.0);
  EXPECT_GT(six_db, 34.0);
  // Sharpening gives some of it back, but the model is no noisier than one picture.
  EXPECT_GT(fitted_db, 30.0);
}

TEST(ColorSurface, SubdividesToThePixelAndKeepsTheGeometry) {
  const ExtractedSurface surface = planeSurface(kHalf_mm, 4.0);
  const std::vector<Keyframe>& keyframes = plainRing();
  const TexturedMesh model = colored(surface, smallCamera(), keyframes, {});
  EXPECT_EQ(std::memcmp(surface.mesh.vertices.data(),
                        model.mesh.vertices.data(),
                        surface.mesh.vertices.size() * sizeof(Eigen::Vector3f)),
            0);
  // 300 mm away and f = 300 px: about 1 mm a pixel, 0.6 of it between vertices (nearest corner of
  // the plane: 0.85 mm), so on 100 x 100 mm at least (100 / 0.6)^2 / 2 vertices.
  double longest_mm = 0.0;
  for (const Eigen::Vector3i& f : model.mesh.faces) {
    const Eigen::Vector3f d = model.mesh.vertices[static_cast<std::size_t>(f[0])] -
                              model.mesh.vertices[static_cast<std::size_t>(f[1])];
    longest_mm = std::max(longest_mm, static_cast<double>(d.norm()));
  }
  EXPECT_LT(longest_mm, 0.65);
  EXPECT_GT(model.mesh.vertices.size(), 14'000U);
  const TexturedMesh bounded = colored(surface, smallCamera(), keyframes, {.max_vertices = 3000});
  EXPECT_EQ(bounded.mesh.vertices.size(), 3000U);
}

TEST(ColorSurface, DoesNotPaintAnOccluderOntoWhatItHides) {
  TexturedScene scene;
  scene.balls.push_back({.center_mm = {0, 0, 35}, .radius_mm = 14.0, .color = {235, 20, 20}});
  ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  appendBall(surface, scene.balls.front(), 24);
  const std::vector<Keyframe> keyframes = ringOfKeyframes(scene, smallCamera(), 8);
  const TexturedMesh model = colored(surface, smallCamera(), keyframes);
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = model.mesh.vertices[i];
    if (isInnerPlane(p)) {
      // The plane's red is at most 95, the ball's 235; a tenth of it bled in would be 109.
      ASSERT_LT(model.colors[i].r, 105) << p.transpose();
    } else if (p.z() > 40.0F && model.unseen[i] == 0) {
      ASSERT_GT(model.colors[i].r, 200) << p.transpose();
    }
  }
}

TEST(ColorSurface, DoesNotPaintWhatOnlyTheSensorSaw) {
  TexturedScene scene;
  scene.balls.push_back({.center_mm = {10, 0, 60}, .radius_mm = 12.0, .color = {235, 20, 20}});
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);  // the ball is not in the model
  const std::vector<Keyframe> keyframes = ringOfKeyframes(scene, smallCamera(), 8);
  const TexturedMesh model = colored(surface, smallCamera(), keyframes);
  int painted = 0;
  int inner = 0;
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    if (isInnerPlane(model.mesh.vertices[i])) {
      ++inner;
      painted += model.colors[i].r > 110 ? 1 : 0;
    }
  }
  // The sensor's depth ends where the colour does, to half a pixel: a thin rim may take a trace.
  EXPECT_LT(painted, inner / 200);
}

TEST(ColorSurface, MarksTheUnseenAndNeverLeavesItBlack) {
  const TexturedScene scene;
  ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  appendBall(
      surface, {.center_mm = {0, 0, -40}, .radius_mm = 10.0, .color = {}}, 8);  // hidden below
  const std::vector<Keyframe> keyframes = ringOfKeyframes(scene, smallCamera(), 4);
  const auto check = [&](const TexturedMesh& model, const Eigen::Vector3d& wanted, double within) {
    for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
      const bool below = model.mesh.vertices[i].z() < -1.0F;
      EXPECT_EQ(model.unseen[i], below ? 1 : 0);
      if (below) {
        EXPECT_LT((toVector(model.colors[i]) - wanted).cwiseAbs().maxCoeff(), within);
      }
    }
  };
  // No neighbour and no fused colour: the mean of what was seen, near (70, 120, 150).
  check(colored(surface, smallCamera(), keyframes), {70, 120, 150}, 10.0);
  surface.colors.assign(surface.mesh.vertices.size(), Rgb8{180, 140, 120});
  check(colored(surface, smallCamera(), keyframes), {180, 140, 120}, 1.0);
}

TEST(ColorSurface, FillsAnUnseenPatchFromItsRim) {
  TexturedScene scene;
  scene.period_mm = 1e6;  // one colour all over
  ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  // A patch whose normals look away counts as unseen; its fused colour is wrong by a constant.
  surface.colors.assign(surface.mesh.vertices.size(), Rgb8{40, 90, 120});
  for (std::size_t i = 0; i < surface.mesh.vertices.size(); ++i) {
    if (surface.mesh.vertices[i].norm() < 15.0F) {
      surface.mesh.normals[i] = -Eigen::Vector3f::UnitZ();
      surface.colors[i] =
          surface.mesh.vertices[i].norm() < 8.0F ? Rgb8{0, 0, 0} : Rgb8{40, 90, 120};
    }
  }
  const TexturedMesh model =
      colored(surface, smallCamera(), ringOfKeyframes(scene, smallCamera(), 4));
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    if (isInnerPlane(model.mesh.vertices[i])) {
      // Turned normals reach to 15 mm, edges between turned and other vertices 2.9 mm further.
      const float radius_mm = model.mesh.vertices[i].norm();
      if (radius_mm < 12.0F || radius_mm > 18.0F) {
        EXPECT_EQ(model.unseen[i], radius_mm < 15.0F ? 1 : 0) << radius_mm;
      }
      EXPECT_LT((toVector(model.colors[i]) - Eigen::Vector3d(70, 120, 150)).cwiseAbs().maxCoeff(),
                6.0)
          << model.mesh.vertices[i].transpose();
    }
  }
}

TEST(ColorSurface, RemovesDriftOfExposure) {
  const TexturedScene scene;
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  std::vector<Keyframe> keyframes = plainRing();
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const double t = static_cast<double>(k);
    const Eigen::Vector3d gain(1.0 + 0.15 * std::sin(t), 1.0 + 0.12 * std::cos(t), 1.1 - 0.03 * t);
    keyframes[k].frame =
        takeFrame(scene, smallCamera(), keyframes[k].scan_from_camera, {.gain = gain});
  }
  const double raw_db =
      planePsnr(colored(surface,
                        smallCamera(),
                        keyframes,
                        {.vertex_spacing_px = 1.0, .best_views = 2, .level_exposure = false}),
                scene);
  const double level_db = planePsnr(
      colored(surface, smallCamera(), keyframes, {.vertex_spacing_px = 1.0, .best_views = 2}),
      scene);
  std::printf(
      "PSNR, exposure drifting by 15 %%: %.1f dB as it is, %.1f dB levelled\n", raw_db, level_db);
  EXPECT_GT(level_db, 36.0);
  EXPECT_GT(level_db, raw_db + 6.0);
}

TEST(ColorSurface, UsesTheColourCamerasOwnPlaceAndLens) {
  const TexturedScene scene;
  RgbdCamera camera = smallCamera();
  camera.color = {
      .width = 400, .height = 300, .fx_px = 390, .fy_px = 385, .cx_px = 190, .cy_px = 155};
  camera.color_from_depth.translation() = Eigen::Vector3d(-25.0, 3.0, 1.0);
  camera.color_from_depth.linear() =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  const std::vector<Keyframe> keyframes = ringOfKeyframes(scene, camera, 8);
  const double psnr_db = planePsnr(colored(surface, camera, keyframes), scene);
  RgbdCamera wrong = camera;
  wrong.color_from_depth = RigidTransform::Identity();
  const double wrong_db = planePsnr(colored(surface, wrong, keyframes), scene);
  std::printf(
      "PSNR, offset colour camera: %.1f dB, %.1f dB if taken for aligned\n", psnr_db, wrong_db);
  EXPECT_GT(psnr_db, 38.0);
  EXPECT_LT(wrong_db, 30.0);  // the test can tell
}

TEST(ColorSurface, PrefersSharpViews) {
  const TexturedScene scene;
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  std::vector<Keyframe> keyframes = plainRing();
  for (std::size_t k = 0; k < keyframes.size(); k += 2) {
    keyframes[k].frame =
        takeFrame(scene, smallCamera(), keyframes[k].scan_from_camera, {.blur_px = 9});
    keyframes[k].blur = blurMeasure(keyframes[k].frame.color);
  }
  const double weighted_db = planePsnr(colored(surface, smallCamera(), keyframes), scene);
  for (Keyframe& keyframe : keyframes) {
    keyframe.blur = 0.3;
  }
  const double even_db = planePsnr(colored(surface, smallCamera(), keyframes), scene);
  std::printf("PSNR, every second view blurred: %.1f dB by sharpness, %.1f dB evenly\n",
              weighted_db,
              even_db);
  EXPECT_GT(weighted_db, even_db + 1.0);
}

TEST(ColorSurface, GivesTheSameBitsOnAnyNumberOfThreads) {
  const ExtractedSurface surface = planeSurface(kHalf_mm, 4.0);
  const std::vector<Keyframe> keyframes = ringOfKeyframes({}, smallCamera(), 4, 3.0);
  const auto a = colorSurface(surface, smallCamera(), keyframes, {}, Job{});
  const ThreadLimit limit(1);
  const auto b = colorSurface(surface, smallCamera(), keyframes, {}, Job{});
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->model.sha256, b->model.sha256);
  EXPECT_EQ(a->model.unseen, b->model.unseen);
  EXPECT_EQ(a->model.sha256.size(), 64U);
}

TEST(ColorSurface, RefusesWhatItCannotColour) {
  const std::vector<Keyframe> keyframes = ringOfKeyframes({}, smallCamera(), 1);
  const ExtractedSurface surface = planeSurface(10.0, 5.0);
  const auto code = [](const Expected<ColoredSurface>& result) {
    EXPECT_FALSE(result.has_value());
    return result ? ErrorCode::BadOption : result.error().code;
  };
  EXPECT_EQ(code(colorSurface({}, smallCamera(), keyframes, {}, Job{})), ErrorCode::SurfaceEmpty);
  EXPECT_EQ(code(colorSurface(surface, smallCamera(), {}, {}, Job{})), ErrorCode::KeyframesMissing);
  RgbdCamera other = smallCamera();
  other.color.width = 640;
  EXPECT_EQ(code(colorSurface(surface, other, keyframes, {}, Job{})),
            ErrorCode::CameraFactsInvalid);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(
      code(colorSurface(surface, smallCamera(), keyframes, {}, Job{.stop = stop.get_token()})),
      ErrorCode::Cancelled);
}

TEST(PhotometricRmse, IsTheNoiseOfTheImagesForGoodPosesAndGrowsWithBadOnes) {
  const TexturedScene scene;
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  std::vector<Keyframe> keyframes = ringOfKeyframes(scene, smallCamera(), 8, 6.0);
  const TexturedMesh model = colored(surface, smallCamera(), keyframes, {});
  const double good = photometricRmse(
      model, smallCamera(), keyframes, placementsByPose(smallCamera(), keyframes), {});
  // Luminance of independent noise of 6 levels per channel: 6 * |(0.299, 0.587, 0.114)| = 4.0, less
  // by bilinear sampling (two thirds), more by the model's own noise and the rim's background.
  EXPECT_GT(good, 2.0);
  EXPECT_LT(good, 6.0);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    keyframes[k].scan_from_camera.translation().x() += k % 2 == 0 ? 2.0 : -2.0;
  }
  const TexturedMesh shifted = colored(surface, smallCamera(), keyframes);
  EXPECT_GT(photometricRmse(
                shifted, smallCamera(), keyframes, placementsByPose(smallCamera(), keyframes), {}),
            2.0 * good);
  EXPECT_EQ(photometricRmse(model, smallCamera(), {}, {}, {}), 0.0);
}

}  // namespace
}  // namespace tarsus
