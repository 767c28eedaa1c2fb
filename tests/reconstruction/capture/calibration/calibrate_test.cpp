#include "tests/reconstruction/capture/calibration/board_scene.h"

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

class SimulatedBoards : public testing::TestWithParam<int> {};

TEST_P(SimulatedBoards, TruthIsFoundWithinTheIssuesBounds) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const BoardScene scene = usualScene();
  const CalibrationCapture capture = captureOf(scene, usualPlaces(scene, 20, seed), seed);
  const auto profile = calibrateCameras(capture, optionsOf(scene));
  ASSERT_TRUE(profile) << describe(profile.error());
  const RgbdCamera& found = profile->camera;
  for (const ViewResult& v : profile->views) {
    std::printf("%s c'%s' i'%s' d'%s' %.3f %.3f %.3f z %.0f tilt %.1f\n",
                v.name.c_str(),
                v.color_refused.c_str(),
                v.infrared_refused.c_str(),
                v.depth_refused.c_str(),
                v.color_rms_px.value_or(-1),
                v.infrared_rms_px.value_or(-1),
                v.depth_rms_mm.value_or(-1),
                v.distance_mm.value_or(-1),
                v.tilt_rad.value_or(-1) * 57.3);
  }
  std::printf("color %.3f%% %.3f%% c %.2f %.2f  depth %.3f%% %.3f%% c %.2f %.2f\n",
              100 * (found.color.fx_px / scene.camera.color.fx_px - 1),
              100 * (found.color.fy_px / scene.camera.color.fy_px - 1),
              found.color.cx_px - scene.camera.color.cx_px,
              found.color.cy_px - scene.camera.color.cy_px,
              100 * (found.depth.fx_px / scene.camera.depth.fx_px - 1),
              100 * (found.depth.fy_px / scene.camera.depth.fy_px - 1),
              found.depth.cx_px - scene.camera.depth.cx_px,
              found.depth.cy_px - scene.camera.depth.cy_px);
  const auto& sd = profile->color.deviation;
  const auto& sdd = profile->depth->deviation;
  std::printf("sd color %.3f%% c %.2f %.2f depth %.3f%% c %.2f %.2f rms %.3f %.3f cov %.2f %.2f\n",
              100 * sd.fx_px / 600,
              sd.cx_px,
              sd.cy_px,
              100 * sdd.fx_px / 355,
              sdd.cx_px,
              sdd.cy_px,
              profile->color.rms_px,
              profile->depth->rms_px,
              profile->color.coverage,
              profile->depth->coverage);
  std::printf("dist c");
  for (double d : found.color.distortion) std::printf(" %.4f", d);
  std::printf(" d");
  for (double d : found.depth.distortion) std::printf(" %.4f", d);
  std::printf("\n");
  const Eigen::Vector3d dt =
      found.color_from_depth.translation() - scene.camera.color_from_depth.translation();
  std::printf("ext %.3f %.3f %.3f mm (sd %.3f %.3f %.3f) %.4f deg\n",
              dt.x(),
              dt.y(),
              dt.z(),
              profile->extrinsics->translation_mm[0],
              profile->extrinsics->translation_mm[1],
              profile->extrinsics->translation_mm[2],
              degreesBetween(found.color_from_depth, scene.camera.color_from_depth));
  ASSERT_TRUE(profile->depth_correction);
  std::printf("scale %.3f%% sd %.3f%% terms %s before %.3f after %.3f range %.0f %.0f\n",
              100 * (profile->depth_correction->scale / scene.error.scale - 1),
              100 * profile->depth_fit->scale_deviation,
              profile->depth_fit->terms.c_str(),
              profile->depth_fit->rms_before_mm,
              profile->depth_fit->rms_after_mm,
              profile->depth_fit->near_mm,
              profile->depth_fit->far_mm);
  for (const Warning& w : profile->warnings)
    std::printf("W %s %s\n", w.code.c_str(), w.text.c_str());
}

INSTANTIATE_TEST_SUITE_P(Seeds, SimulatedBoards, testing::Values(1, 2, 3));

}  // namespace
}  // namespace tarsus
