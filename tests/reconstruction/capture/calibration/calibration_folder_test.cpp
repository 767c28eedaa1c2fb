#include "reconstruction/capture/calibration/calibration_folder.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/image_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

RgbdCamera smallCamera() {
  RgbdCamera camera;
  camera.depth = {.width = 8, .height = 6, .fx_px = 9.0, .fy_px = 9.0, .cx_px = 4.0, .cy_px = 3.0};
  camera.color = camera.depth;
  camera.serial = "0042";
  return camera;
}

/// One view under two names, the second without infrared.
void writeViews(const std::filesystem::path& folder) {
  ColorImage color(8, 6);
  color.at(2, 3) = {.r = 10, .g = 20, .b = 30};
  DepthImage units(8, 6);
  units.at(2, 3) = 54321.0F;
  ASSERT_TRUE(writeColorImage(folder / "color" / "0001.png", color));
  ASSERT_TRUE(writeColorImage(folder / "color" / "0002.png", color));
  ASSERT_TRUE(writeDepthImage(folder / "ir" / "0001.png", units, 1000.0));
  ASSERT_TRUE(writeDepthImage(folder / "depth" / "0002.png", units, 1000.0));
  ASSERT_TRUE(writeCamera(folder / "camera.json", smallCamera()));
}

TEST(CalibrationFolder, FilesOfOneNameAreOneView) {
  const TemporaryFolder folder;
  writeViews(folder.path());
  const auto capture = readCalibrationFolder(folder.path());
  ASSERT_TRUE(capture) << describe(capture.error());
  ASSERT_EQ(capture->views.size(), 2U);
  EXPECT_EQ(capture->nominal->serial, "0042");
  EXPECT_EQ(capture->views[0].name, "0001");
  EXPECT_EQ(capture->views[0].color.at(2, 3).b, 30);
  EXPECT_EQ(capture->views[0].infrared.at(2, 3), 54321);
  EXPECT_EQ(capture->views[0].depth.width(), 0);
  EXPECT_EQ(capture->views[1].infrared.width(), 0);
  EXPECT_EQ(capture->views[1].depth.at(2, 3), 54321);
  EXPECT_TRUE(capture->warnings.empty());
}

TEST(CalibrationFolder, InfraredMayHaveEightBits) {
  const TemporaryFolder folder;
  writeViews(folder.path());
  ColorImage grey(8, 6);
  grey.at(2, 3) = {.r = 77, .g = 77, .b = 77};
  ASSERT_TRUE(writeColorImage(folder.path() / "ir" / "0002.png", grey));
  const auto capture = readCalibrationFolder(folder.path());
  ASSERT_TRUE(capture);
  EXPECT_EQ(capture->views[1].infrared.at(2, 3), 77);
}

TEST(CalibrationFolder, JunkIsPassedOverWithAWarning) {
  const TemporaryFolder folder;
  writeViews(folder.path());
  ASSERT_TRUE(writeTextAtomically(folder.path() / "color" / "0001.png", "no picture"));
  ASSERT_TRUE(writeTextAtomically(folder.path() / "color" / "0003.png", ""));
  ASSERT_TRUE(writeTextAtomically(folder.path() / "color" / "notes.txt", "no view"));
  const auto capture = readCalibrationFolder(folder.path());
  ASSERT_TRUE(capture);
  ASSERT_EQ(capture->views.size(), 2U);
  EXPECT_EQ(capture->views[0].color.width(), 0);
  ASSERT_EQ(capture->warnings.size(), 2U);
  EXPECT_EQ(capture->warnings[0].code, "image_skipped");
  EXPECT_NE(capture->warnings[0].text.find("0001.png"), std::string::npos);
}

TEST(CalibrationFolder, EmptyAndMissingOnesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(readCalibrationFolder(folder.path()).error().code, ErrorCode::CalibrationFailed);
  EXPECT_EQ(readCalibrationFolder(folder.path() / "none").error().code, ErrorCode::FileMissing);
  ASSERT_TRUE(writeTextAtomically(folder.path() / "color" / "0001.png", "no picture"));
  const auto junk = readCalibrationFolder(folder.path());
  ASSERT_FALSE(junk);
  EXPECT_NE(junk.error().detail.find("0001.png"), std::string::npos) << junk.error().detail;
  ASSERT_TRUE(writeTextAtomically(folder.path() / "camera.json", "{"));
  EXPECT_EQ(readCalibrationFolder(folder.path()).error().code, ErrorCode::CameraFactsInvalid);
}

}  // namespace
}  // namespace tarsus
