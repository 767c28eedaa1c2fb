#include "reconstruction/capture/camera_file.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace tarsus {
namespace {

constexpr const char* kWhole = R"({
 "depth": {"width": 640, "height": 480, "fx": 600, "fy": 601, "cx": 320, "cy": 240,
           "distortion": [0.1, -0.2, 0.001, 0.002, 0.05]},
 "color": {"width": 1920, "height": 1080, "fx": 1400, "fy": 1401, "cx": 960, "cy": 540},
 "depth_scale": 8000, "fps": 60, "firmware": {"kept": "ignored"},
 "color_from_depth": [[1,0,0,0.0256],[0,1,0,0],[0,0,1,-0.004],[0,0,0,1]]})";

Expected<RgbdCamera> parse(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "camera.json") << text;
  return readCamera(folder.path() / "camera.json");
}

TEST(CameraFile, ReadsEveryFactInMillimetres) {
  auto camera = parse(kWhole);
  ASSERT_TRUE(camera) << describe(camera.error());
  EXPECT_EQ(camera->depth.width, 640);
  EXPECT_EQ(camera->depth.distortion[4], 0.05);
  EXPECT_EQ(camera->color.fy_px, 1401.0);
  EXPECT_NEAR(camera->color_from_depth.translation().x(), 25.6, 1e-12);
  EXPECT_EQ(camera->depth_units_per_m, 8000.0);
  EXPECT_EQ(camera->frames_per_s, 60.0);
}

TEST(CameraFile, WrittenFactsComeBack) {
  const TemporaryFolder folder;
  ScanFacts facts;
  facts.depth_correction = DepthCorrection{.scale = 1.01, .polynomial = {}};
  facts.depth_correction->polynomial[1] = {0.1, 0.2, 0.3, 0.4, 0.5, -0.6};
  facts.seconds_since_power_on = 12.5;
  ASSERT_TRUE(writeCamera(folder.path() / "camera.json", *parse(kWhole), facts));
  const auto read = readScanFacts(folder.path() / "camera.json");
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_EQ(read->depth_correction, facts.depth_correction);
  EXPECT_EQ(read->seconds_since_power_on, facts.seconds_since_power_on);
  ASSERT_TRUE(writeCamera(folder.path() / "camera.json", *parse(kWhole)));
  EXPECT_FALSE(readScanFacts(folder.path() / "camera.json")->depth_correction);
}

TEST(CameraFile, ShortDistortionMeansTheRestIsZero) {
  std::string text = kWhole;
  text.replace(text.find("[0.1, -0.2, 0.001, 0.002, 0.05]"), 31, "[0.1, -0.2]");
  auto camera = parse(text);
  ASSERT_TRUE(camera) << describe(camera.error());
  EXPECT_EQ(camera->depth.distortion[1], -0.2);
  EXPECT_EQ(camera->depth.distortion[4], 0.0);
}

TEST(CameraFile, EachMissingFactIsNamed) {
  for (const char* key : {"\"fx\"", "\"width\"", "\"depth_scale\"", "\"color\""}) {
    std::string text = kWhole;
    text.replace(text.find(key), 3, "\"zz");
    auto camera = parse(text);
    ASSERT_FALSE(camera) << key;
    EXPECT_EQ(camera.error().code, ErrorCode::CameraFactsInvalid);
    EXPECT_NE(camera.error().detail.find(std::string(key).substr(1, 2)), std::string::npos)
        << camera.error().detail;
  }
}

/// Slips of the pen that would make wrong millimetres without a word.
TEST(CameraFile, RefusesLensesThatNoCameraHas) {
  const std::vector<std::pair<std::string, std::string>> slips{
      {"\"fx\": 600", "\"fx\": 60000"},
      {"\"fx\": 600", "\"fx\": 6.0"},
      {"\"fy\": 601", "\"fy\": 61"},
      {"\"cx\": 320", "\"cx\": 32000"},
      {"[0.1, -0.2, 0.001, 0.002, 0.05]", "[5, -3, 0, 0, 0]"},
      {"[0.1, -0.2, 0.001, 0.002, 0.05]", "[0, 0, 1, 0, 0]"}};
  for (const auto& [right, wrong] : slips) {
    std::string text = kWhole;
    ASSERT_NE(text.find(right), std::string::npos) << right;
    text.replace(text.find(right), right.size(), wrong);
    const auto camera = parse(text);
    ASSERT_FALSE(camera) << wrong;
    EXPECT_NE(camera.error().detail.find("no camera has"), std::string::npos)
        << camera.error().detail;
  }
}

TEST(CameraFile, RefusesACorrectionThatNoCameraNeeds) {
  const TemporaryFolder folder;
  for (const double c0_mm : {200.0, -100.0}) {
    ScanFacts facts;
    facts.depth_correction = DepthCorrection{.scale = 1.0, .polynomial = {}};
    facts.depth_correction->polynomial[0][0] = c0_mm;
    ASSERT_TRUE(writeCamera(folder.path() / "camera.json", *parse(kWhole), facts));
    EXPECT_FALSE(readScanFacts(folder.path() / "camera.json")) << c0_mm;
  }
}

TEST(CameraFile, RefusesWhatIsNoObject) {
  for (const char* text : {"", "[]", "3", "null", "{}", "{\"depth\":[1]}"}) {
    auto camera = parse(text);
    ASSERT_FALSE(camera) << text;
    EXPECT_EQ(camera.error().code, ErrorCode::CameraFactsInvalid);
  }
}

}  // namespace
}  // namespace tarsus
