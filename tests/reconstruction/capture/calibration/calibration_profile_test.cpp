#include "reconstruction/capture/calibration/calibration_profile.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/calibration/known_camera.h"
#include "reconstruction/capture/camera_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tarsus {
namespace {

Intrinsics lens(int width, int height, double focal_px) {
  return {.width = width,
          .height = height,
          .fx_px = focal_px,
          .fy_px = focal_px + 1.0,
          .cx_px = 0.5 * width,
          .cy_px = 0.5 * height,
          .distortion = {0.1, -0.2, 0.001, 0.002, 0.0}};
}

CalibrationProfile someProfile(const std::string& date = "2026-03-31") {
  CalibrationProfile profile;
  profile.date = date;
  profile.camera.depth = lens(480, 360, 356.0);
  profile.camera.color = lens(640, 480, 615.0);
  profile.camera.color_from_depth.translation() = Eigen::Vector3d(25.0, 0.5, -1.0);
  profile.camera.model = "Test camera";
  profile.camera.serial = "0042";
  profile.depth_correction = DepthCorrection{.scale = 1.01, .polynomial = {}};
  profile.color = {.views = 18,
                   .rms_px = 0.06,
                   .coverage = 0.9,
                   .near_mm = 310.0,
                   .far_mm = 620.0,
                   .turn_rad = 1.1,
                   .deviation = lens(640, 480, 0.4)};
  profile.depth = profile.color;
  profile.extrinsics = ExtrinsicsFit{
      .views = 17, .rotation_rad = {1e-4, 2e-4, 3e-4}, .translation_mm = {0.1, 0.2, 0.3}};
  profile.depth_fit = DepthFit{.views = 16, .near_mm = 300.0, .far_mm = 640.0, .terms = "scale"};
  profile.views = {{.name = "0000", .color_rms_px = 0.05, .distance_mm = 400.0},
                   {.name = "0001", .color_refused = "the board was not found"}};
  profile.warnings = {{"calibration_coverage", "The board never reached the left part."}};
  return profile;
}

std::vector<std::string> codes(const Warnings& warnings) {
  std::vector<std::string> result;
  for (const Warning& warning : warnings) {
    result.push_back(warning.code);
  }
  return result;
}

using Codes = std::vector<std::string>;

TEST(CalibrationFile, ComesBackAsItWas) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "calibration.json";
  ASSERT_TRUE(writeCalibration(path, someProfile()));
  const auto read = readCalibration(path);
  ASSERT_TRUE(read) << describe(read.error());
  const CalibrationProfile truth = someProfile();
  EXPECT_EQ(read->date, truth.date);
  EXPECT_EQ(read->camera.depth, truth.camera.depth);
  EXPECT_EQ(read->camera.color, truth.camera.color);
  EXPECT_TRUE(read->camera.color_from_depth.isApprox(truth.camera.color_from_depth, 1e-12));
  EXPECT_EQ(read->camera.serial, "0042");
  EXPECT_EQ(read->depth_correction, truth.depth_correction);
  EXPECT_EQ(read->board.columns, 9);
  EXPECT_EQ(read->color.deviation, truth.color.deviation);
  EXPECT_EQ(read->extrinsics->translation_mm, truth.extrinsics->translation_mm);
  EXPECT_EQ(read->depth_fit->terms, "scale");
  ASSERT_EQ(read->views.size(), 2U);
  EXPECT_EQ(read->views[0].color_rms_px, 0.05);
  EXPECT_FALSE(read->views[0].tilt_rad);
  EXPECT_EQ(read->views[1].color_refused, "the board was not found");
  EXPECT_EQ(read->warnings[0].text, truth.warnings[0].text);
}

TEST(CalibrationFile, IsACameraFileToo) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "calibration.json";
  ASSERT_TRUE(writeCalibration(path, someProfile()));
  EXPECT_EQ(readCamera(path)->color, someProfile().camera.color);
  EXPECT_EQ(readScanFacts(path)->depth_correction, someProfile().depth_correction);
}

TEST(CalibrationFile, MalformedOnesAreRefusedWithTheirField) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "calibration.json";
  ASSERT_TRUE(writeCalibration(path, someProfile()));
  const auto whole = nlohmann::json::parse(*readTextFile(path));
  using Pointer = nlohmann::json::json_pointer;
  const std::vector<std::pair<std::string, nlohmann::json>> bad = {
      {"/depth", 3},
      {"/calibration", nullptr},
      {"/calibration/date", "2026-02-30"},
      {"/calibration/date", 20260331},
      {"/calibration/board/columns", "nine"},
      {"/calibration/color/views", -1},
      {"/calibration/color_from_depth/translation_standard_deviation_mm", {1, 2}},
      {"/calibration/views", "many"},
      {"/calibration/views/0", 7},
      {"/calibration/warnings/0", 7}};
  for (const auto& [field, value] : bad) {
    nlohmann::json changed = whole;
    changed[Pointer(field)] = value;
    ASSERT_TRUE(writeTextAtomically(path, changed.dump()));
    const auto read = readCalibration(path);
    ASSERT_FALSE(read) << field;
    EXPECT_EQ(read.error().code, ErrorCode::CameraFactsInvalid) << field;
    const std::string name = field.substr(field.rfind('/') + 1);
    EXPECT_TRUE(name == "0" || read.error().detail.find(name) != std::string::npos)
        << read.error().detail;
  }
  for (const char* text : {"", "[]", "3", "{\"depth\": "}) {
    ASSERT_TRUE(writeTextAtomically(path, text));
    EXPECT_FALSE(readCalibration(path)) << text;
  }
  EXPECT_EQ(readCalibration(folder.path() / "none.json").error().code, ErrorCode::FileMissing);
}

TEST(NewestCalibration, IsThatOfTheSerialWithTheLatestDate) {
  const TemporaryFolder folder;
  CalibrationProfile other = someProfile("2026-09-01");
  other.camera.serial = "0043";
  for (const CalibrationProfile& profile : {someProfile("2026-03-31"),
                                            someProfile("2026-05-02T10:00:00Z"),
                                            someProfile("2025-12-31"),
                                            other}) {
    ASSERT_TRUE(writeCalibration(folder.path() / calibrationFileName(profile), profile));
  }
  ASSERT_TRUE(writeTextAtomically(folder.path() / "broken.json", "{"));
  ASSERT_TRUE(writeTextAtomically(folder.path() / "note.txt", "nothing"));
  const FoundCalibration found = newestCalibration(folder.path(), "0042");
  ASSERT_TRUE(found.profile);
  EXPECT_EQ(found.profile->date, "2026-05-02T10:00:00Z");
  EXPECT_EQ(codes(found.warnings), Codes{"calibration_unreadable"});
  EXPECT_FALSE(newestCalibration(folder.path(), "0044").profile);
  EXPECT_FALSE(newestCalibration(folder.path(), "").profile);
  EXPECT_FALSE(newestCalibration(folder.path() / "none", "0042").profile);
}

TEST(KnownCamera, IsTheNewestOfItsSerialOrNominalWithAWarning) {
  const TemporaryFolder folder;
  CalibrationProfile profile = someProfile("2026-05-02T10:00:00Z");
  ASSERT_TRUE(writeCalibration(folder.path() / "a.json", profile));
  RgbdCamera sensor = profile.camera;
  sensor.depth.fx_px *= 1.05;
  const auto known = knownCamera(sensor, folder.path(), "2026-06-01");
  ASSERT_TRUE(known) << describe(known.error());
  EXPECT_TRUE(known->calibrated);
  EXPECT_EQ(known->camera.depth.fx_px, profile.camera.depth.fx_px);
  sensor.serial = "another";
  const auto other = knownCamera(sensor, folder.path(), "2026-06-01");
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->calibrated);
  EXPECT_EQ(codes(other->warnings), Codes{"calibration_missing"});
  // A file that is named is not taken for another camera.
  const auto refused = knownCamera(sensor, folder.path() / "a.json", "2026-06-01");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().detail.find("is camera another"), std::string::npos)
      << refused.error().detail;
}

TEST(CalibrationFileName, HoldsNothingThatLeavesTheFolder) {
  CalibrationProfile profile = someProfile("2026-05-02T10:00:00Z");
  EXPECT_EQ(calibrationFileName(profile), "0042_2026-05-02T10-00-00Z.json");
  profile.camera.serial = "../a b";
  EXPECT_EQ(calibrationFileName(profile), "---a-b_2026-05-02T10-00-00Z.json");
}

TEST(CalibrationAge, CountsCalendarDays) {
  EXPECT_EQ(ageInDays("2026-03-31", "2026-03-31"), 0);
  EXPECT_EQ(ageInDays("2024-02-28", "2024-03-01T00:00:01Z"), 2);  // leap year
  EXPECT_EQ(ageInDays("2025-03-31", "2026-03-31"), 365);
  EXPECT_EQ(ageInDays("2026-01-02", "2026-01-01"), -1);
  for (const char* bad : {"",
                          "2026",
                          "2026-13-01",
                          "2026-02-29",
                          "2026/02/02",
                          "2026-2-2",
                          "2026-02-02 10",
                          "+026-02-02"}) {
    EXPECT_FALSE(ageInDays("2026-01-01", bad)) << bad;
    EXPECT_FALSE(ageInDays(bad, "2026-01-01")) << bad;
  }
}

TEST(DoubtsAboutCalibration, MissingOldAndOther) {
  const CalibrationProfile profile = someProfile("2025-03-31");
  const RgbdCamera camera = profile.camera;
  EXPECT_EQ(codes(doubtsAboutCalibration(nullptr, camera, "2026-03-31")),
            Codes{"calibration_missing"});
  EXPECT_TRUE(doubtsAboutCalibration(&profile, camera, "2026-03-31").empty());  // day 365
  const Warnings old = doubtsAboutCalibration(&profile, camera, "2026-04-01");
  EXPECT_EQ(codes(old), Codes{"calibration_old"});
  EXPECT_NE(old[0].text.find("366 days"), std::string::npos) << old[0].text;
  EXPECT_EQ(codes(doubtsAboutCalibration(&profile, camera, "2025-03-30")),
            Codes{"calibration_date_doubtful"});
  RgbdCamera wide = camera;
  wide.color.height = 360;
  EXPECT_EQ(codes(doubtsAboutCalibration(&profile, wide, "2025-04-01")),
            Codes{"calibration_other_size"});
  CalibrationProfile color_only = profile;
  color_only.depth.reset();
  EXPECT_EQ(codes(doubtsAboutCalibration(&color_only, camera, "2025-04-01")),
            Codes{"depth_camera_not_calibrated"});
}

TEST(Calibrated, TakesThePlaceOfTheNominalCamera) {
  const CalibrationProfile profile = someProfile();
  RgbdCamera nominal;
  nominal.depth = lens(480, 360, 350.0);
  nominal.color = lens(1280, 960, 1200.0);  // twice the size
  nominal.depth_units_per_m = 8000.0;
  nominal.serial = "as found";
  const RgbdCamera camera = calibrated(nominal, profile);
  EXPECT_EQ(camera.depth, profile.camera.depth);
  EXPECT_EQ(camera.color.fx_px, 2.0 * profile.camera.color.fx_px);
  EXPECT_EQ(camera.color.cx_px, 2.0 * (profile.camera.color.cx_px + 0.5) - 0.5);
  EXPECT_EQ(camera.color.distortion, profile.camera.color.distortion);
  EXPECT_EQ(camera.color_from_depth.translation().x(), 25.0);
  EXPECT_EQ(camera.depth_units_per_m, 8000.0);
  EXPECT_EQ(camera.serial, "as found");
  nominal.color = lens(1280, 720, 1200.0);  // another shape: a part of the image is cut off
  EXPECT_EQ(calibrated(nominal, profile).color, nominal.color);
}

}  // namespace
}  // namespace tarsus
