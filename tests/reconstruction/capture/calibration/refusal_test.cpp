#include "reconstruction/capture/calibration/calibration.h"
#include "tests/reconstruction/capture/calibration/board_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

/// Small and colour only: quick to draw.
BoardScene smallScene() {
  BoardScene scene = usualScene();
  scene.infrared = false;
  scene.depth = false;
  Intrinsics& color = scene.camera.color;
  color = {.width = 320,
           .height = 240,
           .fx_px = 307.0,
           .fy_px = 308.0,
           .cx_px = 161.0,
           .cy_px = 118.0,
           .distortion = {}};
  return scene;
}

CalibrationOptions optionsOf(const BoardScene& scene) {
  return {.board = scene.board, .date = "2026-03-31"};
}

std::vector<RigidTransform> parallelPlaces(const BoardScene& scene, int count) {
  std::vector<RigidTransform> places;
  for (int i = 0; i < count; ++i) {
    places.push_back(placeAt(scene, {-40.0 + 5.0 * i, -20.0 + 8.0 * (i % 4), 400.0}, 0.0, 0.0));
  }
  return places;
}

void expectRefusal(const CalibrationCapture& capture,
                   const CalibrationOptions& options,
                   ErrorCode code,
                   const std::string& says) {
  const auto profile = calibrateCameras(capture, options);
  ASSERT_FALSE(profile) << says;
  EXPECT_EQ(profile.error().code, code) << describe(profile.error());
  EXPECT_NE(profile.error().detail.find(says), std::string::npos) << profile.error().detail;
}

TEST(CalibrationRefuses, BoardsThatAreAllParallel) {
  const BoardScene scene = smallScene();
  expectRefusal(captureOf(scene, parallelPlaces(scene, 10), 1),
                optionsOf(scene),
                ErrorCode::CalibrationFailed,
                "tilt the board");
}

TEST(CalibrationRefuses, ParallelBoardsAtSeveralDistancesToo) {
  const BoardScene scene = smallScene();
  std::vector<RigidTransform> places;
  for (int i = 0; i < 10; ++i) {
    places.push_back(placeAt(scene, {-20.0, 5.0 * (i % 3), 350.0 + 25.0 * i}, 0.2, 0.0));
  }
  expectRefusal(captureOf(scene, places, 1),
                optionsOf(scene),
                ErrorCode::CalibrationFailed,
                "tilt the board");
}

TEST(CalibrationRefuses, ADepthUnitThatIsEightTimesWrong) {
  BoardScene scene = smallScene();
  scene.depth = true;
  scene.camera.depth = {
      .width = 160, .height = 120, .fx_px = 150.0, .fy_px = 150.0, .cx_px = 80.0, .cy_px = 60.0};
  CalibrationCapture capture = captureOf(scene, usualPlaces(scene, 12, 4), 4);
  ASSERT_TRUE(calibrateCameras(capture, optionsOf(scene)));
  capture.nominal->depth_units_per_m = 1000.0;  // it is 8000
  expectRefusal(
      capture, optionsOf(scene), ErrorCode::CalibrationFailed, "\"depth_scale\" of camera.json");
}

TEST(CalibrationWarns, WhereTheBoardNeverWas) {
  const BoardScene scene = smallScene();
  std::vector<RigidTransform> places;
  for (int i = 0; i < 10; ++i) {
    const double side = 0.63 * i;  // all round
    places.push_back(
        placeAt(scene, {-60.0, 0.0, 520.0}, 0.5 * std::cos(side), 0.5 * std::sin(side)));
  }
  const auto profile = calibrateCameras(captureOf(scene, places, 5), optionsOf(scene));
  ASSERT_TRUE(profile) << describe(profile.error());
  ASSERT_FALSE(profile->warnings.empty());
  EXPECT_EQ(profile->warnings[0].code, "calibration_coverage");
  EXPECT_NE(profile->warnings[0].text.find("right, upper, lower part of the colour image"),
            std::string::npos)
      << profile->warnings[0].text;
  EXPECT_LT(profile->color.coverage, 0.5);
}

TEST(CalibrationRefuses, TooFewViews) {
  const BoardScene scene = smallScene();
  expectRefusal(captureOf(scene, usualPlaces(scene, 7, 2), 2),
                optionsOf(scene),
                ErrorCode::CalibrationFailed,
                "only 7 views");
}

TEST(CalibrationRefuses, AnotherBoardThanWasSaid) {
  const BoardScene scene = smallScene();
  CalibrationOptions options = optionsOf(scene);
  options.board.rows = 7;
  expectRefusal(captureOf(scene, usualPlaces(scene, 3, 3), 3),
                options,
                ErrorCode::CalibrationFailed,
                "9 x 7 inner corners was found in 0 of 3 views");
}

TEST(CalibrationRefuses, JunkImages) {
  const BoardScene scene = smallScene();
  CalibrationCapture capture;
  capture.nominal = scene.camera;
  std::uint32_t noise = 1;
  for (int i = 0; i < 3; ++i) {
    capture.views.push_back({.name = std::to_string(i), .color = ColorImage(320, 240)});
    for (Rgb8& pixel : capture.views.back().color.pixels()) {
      noise = noise * 1664525U + 1013904223U;
      pixel = {.r = static_cast<std::uint8_t>(noise >> 24U)};
    }
  }
  expectRefusal(capture, optionsOf(scene), ErrorCode::CalibrationFailed, "found in 0 of 3");
}

TEST(CalibrationRefuses, ImagesThatDoNotGoTogether) {
  const BoardScene scene = smallScene();
  const CalibrationOptions options = optionsOf(scene);
  CalibrationCapture capture;
  expectRefusal(capture, options, ErrorCode::CalibrationFailed, "no view with a colour image");
  capture.views.push_back({.name = "a", .color = ColorImage(320, 240)});
  expectRefusal(capture, options, ErrorCode::CameraFactsMissing, "camera.json");
  capture.nominal = scene.camera;
  capture.views.push_back({.name = "b", .color = ColorImage(640, 480)});
  expectRefusal(capture, options, ErrorCode::CalibrationFailed, "view b has 640 x 480");
  capture.views.back().color = ColorImage(320, 240);
  capture.views.back().depth = RawImage(480, 360);
  capture.views.back().infrared = RawImage(320, 240);
  expectRefusal(capture, options, ErrorCode::CalibrationFailed, "must agree");
  capture.views.back().infrared = RawImage();
  capture.nominal->color.width = 640;
  expectRefusal(capture, options, ErrorCode::CalibrationFailed, "camera.json tells");
}

TEST(CalibrationRefuses, OptionsThatCannotBe) {
  const BoardScene scene = smallScene();
  for (const Chessboard& board : {Chessboard{.columns = 2, .rows = 6, .square_mm = 20},
                                  Chessboard{.columns = 6, .rows = 6, .square_mm = 20},
                                  Chessboard{.columns = 9, .rows = 6, .square_mm = -1},
                                  Chessboard{.columns = 9, .rows = 6, .square_mm = NAN}}) {
    expectRefusal({}, {.board = board, .date = "2026-03-31"}, ErrorCode::BadOption, "");
  }
  expectRefusal({}, {.board = scene.board, .date = "yesterday"}, ErrorCode::BadOption, "date");
}

TEST(CalibrationRefuses, WhenItIsStopped) {
  const BoardScene scene = smallScene();
  CalibrationCapture capture;
  capture.nominal = scene.camera;
  capture.views.push_back({.name = "a", .color = ColorImage(320, 240)});
  std::stop_source stop;
  stop.request_stop();
  const auto profile = calibrateCameras(capture, optionsOf(scene), {.stop = stop.get_token()});
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace tarsus
