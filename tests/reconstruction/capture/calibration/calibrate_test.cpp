
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/parallel.h"
#include "tests/reconstruction/capture/calibration/board_scene.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

CalibrationOptions optionsOf(const BoardScene& scene) {
  return {.board = scene.board, .date = "2026-03-31T09:30:00Z"};
}

double degreesBetween(const RigidTransform& a, const RigidTransform& b) {
  const Eigen::Matrix3d turn = a.linear().transpose() * b.linear();
  return Eigen::AngleAxisd(turn).angle() * 180.0 / M_PI;
}

std::string textOf(const CalibrationProfile& profile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(writeCalibration(folder.path() / "c.json", profile));
  return readTextFile(folder.path() / "c.json").value_or("");
}

void expectFocalLength(const Intrinsics& found, const Intrinsics& truth) {
  EXPECT_NEAR(found.fx_px / truth.fx_px, 1.0, 0.003);  // the issue's bound
  EXPECT_NEAR(found.fy_px / truth.fy_px, 1.0, 0.003);
}

/// Standard deviations must be believable: 4 of them hold all but 1 in 16 000.
void expectHonest(const CameraFit& fit, const Intrinsics& found, const Intrinsics& truth) {
  EXPECT_LT(std::abs(found.fx_px - truth.fx_px), 4.0 * fit.deviation.fx_px);
  EXPECT_LT(std::abs(found.fy_px - truth.fy_px), 4.0 * fit.deviation.fy_px);
  EXPECT_LT(std::abs(found.cx_px - truth.cx_px), 4.0 * fit.deviation.cx_px);
  EXPECT_LT(std::abs(found.cy_px - truth.cy_px), 4.0 * fit.deviation.cy_px);
}

/// Of the corrected depth against the truth, anywhere on the boards [share of z].
double worstDepth(const BoardScene& scene, const DepthCorrection& correction) {
  double worst = 0.0;
  for (const double z_mm : {350.0, 450.0, 550.0}) {
    for (const double x : {-0.3, 0.0, 0.3}) {
      for (const double y : {-0.25, 0.0, 0.25}) {
        const Intrinsics pixel{
            .width = 1, .height = 1, .fx_px = 1.0, .fy_px = 1.0, .cx_px = -x, .cy_px = -y};
        DepthImage depth(1, 1);
        depth.at(0, 0) = static_cast<float>(measuredDepth(scene.error, x, y, z_mm));
        const double after_mm = corrected(depth, correction, pixel).at(0, 0);
        worst = std::max(worst, std::abs(after_mm / z_mm - 1.0));
      }
    }
  }
  return worst;
}

class SimulatedBoards : public testing::TestWithParam<int> {};

TEST_P(SimulatedBoards, TruthIsFoundWithinTheIssuesBounds) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const BoardScene scene = usualScene();
  const CalibrationCapture capture = captureOf(scene, usualPlaces(scene, 20, seed), seed);
  const auto profile = calibrateCameras(capture, optionsOf(scene));
  ASSERT_TRUE(profile) << describe(profile.error());
  ASSERT_TRUE(profile->depth && profile->extrinsics && profile->depth_correction);
  const RgbdCamera& found = profile->camera;
  const RgbdCamera& truth = scene.camera;
  expectFocalLength(found.color, truth.color);
  expectFocalLength(found.depth, truth.depth);
  const double shift_mm =
      (found.color_from_depth.translation() - truth.color_from_depth.translation()).norm();
  const double turn_deg = degreesBetween(found.color_from_depth, truth.color_from_depth);
  EXPECT_LT(shift_mm, 0.5);
  EXPECT_LT(turn_deg, 0.2);
  EXPECT_NEAR(profile->depth_correction->scale / scene.error.scale, 1.0, 0.002);
  EXPECT_LT(worstDepth(scene, *profile->depth_correction), 0.002);  // as the scale
  EXPECT_LT(profile->depth_fit->rms_after_mm, 0.2 * profile->depth_fit->rms_before_mm);
  EXPECT_LT(profile->color.rms_px, 0.1);
  EXPECT_LT(profile->depth->rms_px, 0.1);
  EXPECT_GE(profile->color.views, 15);
  expectHonest(profile->color, found.color, truth.color);
  expectHonest(*profile->depth, found.depth, truth.depth);
  std::printf(
      "seed %d: f %.3f %.3f %%, %.3f mm, %.3f deg, scale %.3f %%, depth %.3f %%, rms %.3f "
      "%.3f px, coverage %.2f %.2f, %s, %.3f -> %.3f mm\n",
      GetParam(),
      100.0 * (found.color.fx_px / truth.color.fx_px - 1.0),
      100.0 * (found.depth.fx_px / truth.depth.fx_px - 1.0),
      shift_mm,
      turn_deg,
      100.0 * (profile->depth_correction->scale / scene.error.scale - 1.0),
      100.0 * worstDepth(scene, *profile->depth_correction),
      profile->color.rms_px,
      profile->depth->rms_px,
      profile->color.coverage,
      profile->depth->coverage,
      profile->depth_fit->terms.c_str(),
      profile->depth_fit->rms_before_mm,
      profile->depth_fit->rms_after_mm);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SimulatedBoards, testing::Values(1, 2, 3, 4));

/// A constant, scale and square of z look alike within 0.3 to 0.6 m: single coefficients are not
/// sure then, but the depth is.
TEST(Calibrate, DepthIsRightWhereTheErrorHasAllTerms) {
  BoardScene scene = usualScene();
  scene.error.polynomial[0][0] = 1.0;
  scene.error.polynomial[1] = {0.0, 1.0, -1.0, 0.0, 2.0, 0.0};
  scene.error.polynomial[2][0] = 4.0;
  const auto profile =
      calibrateCameras(captureOf(scene, usualPlaces(scene, 20, 8), 8), optionsOf(scene));
  ASSERT_TRUE(profile) << describe(profile.error());
  ASSERT_TRUE(profile->depth_correction);
  EXPECT_LT(worstDepth(scene, *profile->depth_correction), 0.002);
  std::printf("all terms: scale %.3f +- %.3f %%, depth %.3f %%, %s\n",
              100.0 * (profile->depth_correction->scale / scene.error.scale - 1.0),
              100.0 * profile->depth_fit->scale_deviation,
              100.0 * worstDepth(scene, *profile->depth_correction),
              profile->depth_fit->terms.c_str());
}

TEST(Calibrate, BadViewsAreListedAndChangeLittle) {
  const BoardScene scene = usualScene();
  CalibrationCapture capture = captureOf(scene, usualPlaces(scene, 16, 5), 5);
  capture.views[3].infrared = capture.views[4].infrared;  // moved between the two images
  std::ranges::fill(capture.views[6].color.pixels(), Rgb8{.r = 90, .g = 90, .b = 90});
  std::ranges::fill(capture.views[8].depth.pixels(), std::uint16_t{3200});  // a hand before it
  std::ranges::fill(capture.views[9].depth.pixels(), std::uint16_t{0});
  const auto profile = calibrateCameras(capture, optionsOf(scene));
  ASSERT_TRUE(profile) << describe(profile.error());
  ASSERT_EQ(profile->views.size(), 16U);
  EXPECT_FALSE(profile->views[3].infrared_refused.empty());
  EXPECT_EQ(profile->views[6].color_refused, "the board was not found");
  EXPECT_TRUE(profile->views[6].infrared_refused.empty());  // the other camera saw it
  EXPECT_FALSE(profile->views[8].depth_refused.empty());
  EXPECT_FALSE(profile->views[9].depth_refused.empty());
  expectFocalLength(profile->camera.color, scene.camera.color);
  expectFocalLength(profile->camera.depth, scene.camera.depth);
  EXPECT_LT(degreesBetween(profile->camera.color_from_depth, scene.camera.color_from_depth), 0.2);
  EXPECT_NEAR(profile->depth_correction->scale / scene.error.scale, 1.0, 0.002);
}

TEST(Calibrate, SameBitsTwiceAndWithOneThread) {
  const BoardScene scene = usualScene();
  const CalibrationCapture capture = captureOf(scene, usualPlaces(scene, 10, 6), 6);
  const auto first = calibrateCameras(capture, optionsOf(scene));
  const ThreadLimit limit(1);
  const auto second = calibrateCameras(capture, optionsOf(scene));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(textOf(*first), textOf(*second));
}

TEST(Calibrate, WithoutInfraredTheDepthCameraStaysNominalAndThatIsSaid) {
  BoardScene scene = usualScene();
  scene.infrared = false;
  CalibrationCapture capture = captureOf(scene, usualPlaces(scene, 14, 7), 7);
  capture.nominal->depth = scene.camera.depth;  // a maker who knows
  capture.nominal->color_from_depth = scene.camera.color_from_depth;
  const auto profile = calibrateCameras(capture, optionsOf(scene));
  ASSERT_TRUE(profile) << describe(profile.error());
  EXPECT_FALSE(profile->depth);
  EXPECT_FALSE(profile->extrinsics);
  EXPECT_EQ(profile->camera.depth, capture.nominal->depth);
  EXPECT_TRUE(std::ranges::any_of(profile->warnings, [](const Warning& warning) {
    return warning.code == "depth_camera_not_calibrated";
  }));
  expectFocalLength(profile->camera.color, scene.camera.color);
  ASSERT_TRUE(profile->depth_correction);
  EXPECT_LT(worstDepth(scene, *profile->depth_correction), 0.003);  // one camera knows less
  CalibrationOptions on_wall = optionsOf(scene);
  on_wall.board_on_wall = true;  // the simulated plane is endless
  const auto wall = calibrateCameras(capture, on_wall);
  ASSERT_TRUE(wall && wall->depth_correction);
  EXPECT_LT(worstDepth(scene, *wall->depth_correction), 0.003);
  EXPECT_GT(wall->depth_fit->far_mm, profile->depth_fit->far_mm);  // it looked beyond the board
}

}  // namespace
}  // namespace tarsus
