#include "reconstruction/texture/color_map.h"
#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/keyframe_view.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr double kHalf_mm = 50.0;
constexpr float kInner_mm = 40.0F;
constexpr int kKeyframes = 6;
constexpr double kTurn_rad = 0.5 * std::numbers::pi / 180.0;

/// Three balls on a plane hold a keyframe's depth in all directions.
const TexturedScene& scene() {
  static const TexturedScene kScene{.half_size_mm = kHalf_mm,
                                    .balls = {{.center_mm = {-20, 12, 2}, .radius_mm = 18.0},
                                              {.center_mm = {22, 18, 4}, .radius_mm = 13.0},
                                              {.center_mm = {6, -24, 2}, .radius_mm = 15.0}},
                                    .solid = true};
  return kScene;
}

const ExtractedSurface& surface() {
  static const ExtractedSurface kSurface = [] {
    ExtractedSurface result = planeSurface(kHalf_mm, 2.0);
    for (const SceneBall& ball : scene().balls) {
      appendBall(result, ball, 32);
    }
    return result;
  }();
  return kSurface;
}

const std::vector<Keyframe>& trueKeyframes() {
  static const std::vector<Keyframe> kKeyframesTaken =
      ringOfKeyframes(scene(), smallCamera(), kKeyframes, 2.0);
  return kKeyframesTaken;
}

/// The same pictures with poses off by 2 mm and half a degree, each elsewhere.
std::vector<Keyframe> withWrongPoses(std::vector<Keyframe> keyframes) {
  const auto direction = [](double phase) {
    return Eigen::Vector3d(std::sin(phase), std::cos(1.7 * phase), std::sin(2.3 * phase + 1.0))
        .normalized();
  };
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const double phase = static_cast<double>(k);
    MotionVector off;
    off << kMotionLever_mm * kTurn_rad * direction(1.9 * phase + 0.3), 2.0 * direction(2.9 * phase);
    keyframes[k].scan_from_camera =
        motionOf(off, Eigen::Vector3d::Zero()) * keyframes[k].scan_from_camera;
  }
  return keyframes;
}

/// Coarser vertices than usual: a pixel wide.
ColorMapOptions quick(bool align) { return {.vertex_spacing_px = 1.0, .align = align}; }

ColoredSurface colored(const std::vector<Keyframe>& keyframes,
                       const RgbdCamera& camera,
                       const ColorMapOptions& options,
                       const Job& job = {}) {
  Expected<ColoredSurface> result = colorSurface(surface(), camera, keyframes, options, job);
  EXPECT_TRUE(result.has_value());
  return result ? std::move(*result) : ColoredSurface();
}

Eigen::Vector3d truthAt(const Eigen::Vector3f& p) { return solidColor(p.cast<double>()); }

/// PSNR of seen vertices away from the rim [dB], one gain for all fitted.
double psnr(const TexturedMesh& model) {
  double products = 0.0;
  double squares = 0.0;
  double truths = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    const Eigen::Vector3f& p = model.mesh.vertices[i];
    if (model.unseen[i] == 0 && std::abs(p.x()) < kInner_mm && std::abs(p.y()) < kInner_mm) {
      const Eigen::Vector3d found = colorVector(model.colors[i]).cast<double>();
      products += found.dot(truthAt(p));
      squares += found.squaredNorm();
      truths += truthAt(p).squaredNorm();
      count += 3.0;
    }
  }
  return 10.0 * std::log10(255.0 * 255.0 * count / (truths - products * products / squares));
}

/// How far apart two placements put what lies within the scene [px], at most, warps included.
double greatestSlip(const PicturePlacement& a,
                    const PicturePlacement& b,
                    const Intrinsics& camera) {
  double result = 0.0;
  for (double x = -35.0; x <= 35.0; x += 7.0) {
    for (double y = -35.0; y <= 35.0; y += 7.0) {
      const auto place = [&](const PicturePlacement& placement) {
        const Eigen::Vector3d p = placement.color_from_scan * Eigen::Vector3d(x, y, 5.0);
        return placement.warp.warped(camera.project(p).cast<float>());
      };
      result = std::max(result, static_cast<double>((place(a) - place(b)).norm()));
    }
  }
  return result;
}

/// The darkest of what a picture can show of the scene is 40 levels; half of that is no black.
void expectNoBlack(const TexturedMesh& model) {
  for (const Rgb8& color : model.colors) {
    ASSERT_GT(static_cast<double>(intensityOf(colorVector(color))), 20.0);
  }
}

/// Taken once for several tests.
const std::vector<Keyframe>& wrongKeyframes() {
  static const std::vector<Keyframe> kWrong = withWrongPoses(trueKeyframes());
  return kWrong;
}
const ColoredSurface& alignedFromWrong() {
  static const ColoredSurface kResult = colored(wrongKeyframes(), smallCamera(), quick(true));
  return kResult;
}
const ColoredSurface& unalignedFromWrong() {
  static const ColoredSurface kResult = colored(wrongKeyframes(), smallCamera(), quick(false));
  return kResult;
}

TEST(ColorSurfaceAlignment, MakesUpForWrongPoses) {
  const ColoredSurface truth = colored(trueKeyframes(), smallCamera(), quick(true));
  const ColoredSurface& aligned = alignedFromWrong();
  const ColoredSurface& unaligned = unalignedFromWrong();
  const double truth_db = psnr(truth.model);
  const double aligned_db = psnr(aligned.model);
  const double unaligned_db = psnr(unaligned.model);
  std::printf("PSNR: %.1f dB from true poses, %.1f dB from wrong ones aligned, %.1f dB unaligned\n",
              truth_db,
              aligned_db,
              unaligned_db);
  EXPECT_GT(aligned_db, truth_db - 1.0);
  EXPECT_LT(unaligned_db, aligned_db - 5.0);
  expectNoBlack(truth.model);
  expectNoBlack(aligned.model);
  const std::vector<PicturePlacement> wanted = placementsByPose(smallCamera(), trueKeyframes());
  ASSERT_EQ(aligned.placements.size(), wanted.size());
  ASSERT_EQ(aligned.gains.size(), wanted.size());
  double slip_px = 0.0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    slip_px =
        std::max(slip_px, greatestSlip(aligned.placements[k], wanted[k], smallCamera().color));
    EXPECT_LT((aligned.gains[k].gain - Eigen::Vector3f::Ones()).norm(), 0.03F);
  }
  std::printf("aligned placements within %.2f px of the truth\n", slip_px);
  EXPECT_LT(slip_px, 0.5);
  EXPECT_GT(aligned.alignment.iterations(), 0);
  for (std::size_t i = 1; i < aligned.alignment.rmse.size(); ++i) {
    EXPECT_LE(aligned.alignment.rmse[i], aligned.alignment.rmse[i - 1] * 1.00001);
  }
}

TEST(ColorSurfaceAlignment, ReportsPosesAsGivenWhereNotAskedToAlign) {
  const ColoredSurface& result = unalignedFromWrong();
  const std::vector<PicturePlacement> given = placementsByPose(smallCamera(), wrongKeyframes());
  ASSERT_EQ(result.placements.size(), given.size());
  EXPECT_EQ(result.gains.size(), given.size());
  for (std::size_t k = 0; k < given.size(); ++k) {
    EXPECT_EQ(result.placements[k].color_from_scan.matrix(), given[k].color_from_scan.matrix());
    EXPECT_TRUE(result.placements[k].warp.empty());
  }
  EXPECT_EQ(result.alignment.iterations(), 0);
  EXPECT_EQ(result.alignment.vertex_observations, 0U);
}

TEST(ColorSurfaceAlignment, LeavesNothingBlackWherePicturesContradict) {
  expectNoBlack(unalignedFromWrong().model);
}

TEST(ColorSurfaceAlignment, LowersThePhotometricError) {
  const auto rmseOf = [](const ColoredSurface& result) {
    return photometricRmse(
        result.model, smallCamera(), wrongKeyframes(), result.placements, quick(true));
  };
  const double unaligned = rmseOf(unalignedFromWrong());
  const double aligned = rmseOf(alignedFromWrong());
  std::printf("photometric RMSE %.2f levels unaligned, %.2f aligned\n", unaligned, aligned);
  // Noise of 2 levels a channel is 1.3 in luminance; vertices a pixel apart and slanting views take
  // their part of waves of 10 mm.
  EXPECT_LT(aligned, 3.0);
  EXPECT_GT(unaligned, 2.5 * aligned);
}

TEST(ColorSurfaceAlignment, WorksWithAnOffsetColourCamera) {
  RgbdCamera camera = smallCamera();
  camera.color = {
      .width = 400, .height = 300, .fx_px = 390, .fy_px = 385, .cx_px = 190, .cy_px = 155};
  camera.color_from_depth.translation() = Eigen::Vector3d(-25.0, 3.0, 1.0);
  camera.color_from_depth.linear() =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const std::vector<Keyframe> taken = ringOfKeyframes(scene(), camera, kKeyframes, 2.0);
  const std::vector<Keyframe> wrong = withWrongPoses(taken);
  const ColoredSurface aligned = colored(wrong, camera, quick(true));
  const double unaligned_db = psnr(colored(wrong, camera, quick(false)).model);
  std::printf(
      "offset camera: %.1f dB aligned, %.1f dB unaligned\n", psnr(aligned.model), unaligned_db);
  EXPECT_GT(psnr(aligned.model), 35.0);
  EXPECT_LT(unaligned_db, psnr(aligned.model) - 5.0);
  const std::vector<PicturePlacement> wanted = placementsByPose(camera, taken);
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_LT(greatestSlip(aligned.placements[k], wanted[k], camera.color), 0.6) << k;
  }
}

TEST(ColorSurfaceAlignment, TellsTheGainsOfTheKeyframes) {
  std::vector<Keyframe> keyframes = trueKeyframes();
  const std::vector<float> gains{1.0F, 1.2F, 1.0F, 0.85F, 1.0F, 1.0F};
  for (const std::size_t k : {1U, 3U}) {
    keyframes[k].frame =
        takeFrame(scene(),
                  smallCamera(),
                  keyframes[k].scan_from_camera,
                  {.gain = Eigen::Vector3d::Constant(static_cast<double>(gains[k]))});
  }
  const ColoredSurface result = colored(withWrongPoses(keyframes), smallCamera(), quick(true));
  ASSERT_EQ(result.gains.size(), gains.size());
  for (std::size_t k = 0; k < gains.size(); ++k) {
    for (int channel = 0; channel < 3; ++channel) {
      // Gain and bias together: at the scene's usual levels of 110 to 130.
      const float at_120 = (120.0F * gains[k] - result.gains[k].bias[channel]) / 120.0F;
      EXPECT_NEAR(at_120 / result.gains[k].gain[channel], 1.0F, 0.03F) << k;
    }
  }
}

TEST(ColorSurfaceAlignment, CountsOnlyVerticesThatTwoPicturesSee) {
  // Two keyframes with half of the plane in common.
  std::vector<Keyframe> keyframes;
  for (const double x : {-130.0, 130.0}) {
    Keyframe keyframe;
    keyframe.scan_from_camera = lookAt({x, 0, 300}, {x, 0, 0});
    keyframe.frame = takeFrame(scene(), smallCamera(), keyframe.scan_from_camera);
    keyframes.push_back(std::move(keyframe));
  }
  const ColoredSurface two = colored(keyframes, smallCamera(), quick(true));
  const std::size_t observations = two.alignment.vertex_observations;
  EXPECT_EQ(observations % 2, 0U);
  EXPECT_GT(observations, 0U);
  std::size_t seen = 0;
  for (const std::uint8_t unseen : two.model.unseen) {
    seen += unseen == 0 ? 1U : 0U;
  }
  EXPECT_LT(observations / 2, seen);
  expectNoBlack(two.model);
  const ColoredSurface one = colored({trueKeyframes()[0]}, smallCamera(), quick(true));
  EXPECT_EQ(one.alignment.vertex_observations, 0U);
  EXPECT_GT(psnr(one.model), 30.0);
  EXPECT_LT(greatestSlip(one.placements[0],
                         placementsByPose(smallCamera(), trueKeyframes())[0],
                         smallCamera().color),
            0.1);
  expectNoBlack(one.model);
}

TEST(ColorSurfaceAlignment, GoesOnWhenStoppedDuringAlignment) {
  std::stop_source stop;
  const Job job{.stop = stop.get_token(), .report = [&](std::string_view stage, double) {
                  if (stage == "align colours") {
                    stop.request_stop();
                  }
                }};
  const ColoredSurface result = colored(wrongKeyframes(), smallCamera(), quick(true), job);
  EXPECT_TRUE(stop.stop_requested());
  EXPECT_LE(result.alignment.iterations(), 2);
  EXPECT_EQ(result.placements.size(), trueKeyframes().size());
  // Depth had placed the pictures before.
  EXPECT_GT(psnr(result.model), 30.0);
  expectNoBlack(result.model);
}

}  // namespace
}  // namespace tarsus
