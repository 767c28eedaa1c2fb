#include "reconstruction/capture/device_profile.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tarsus {
namespace {

nlohmann::json wholeProfile() {
  return {{"name", "Some camera"},
          {"models", {"Some", "Other"}},
          {"depth_units_per_m", 8000},
          {"range_mm", {200, 1500}},
          {"warm_up_s", 60},
          {"depth",
           {{"width", 640}, {"height", 480}, {"fx", 600}, {"fy", 601}, {"cx", 320}, {"cy", 240}}},
          {"depth_correction",
           {{"scale", 1.01}, {"polynomial", {{"c1", {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}}}}}},
          {"traps", {"It lies about its unit."}},
          {"more", "is ignored"}};
}

TEST(DeviceProfile, EveryFieldIsRead) {
  const auto profile = parseDeviceProfile(wholeProfile().dump(), "some.json");
  ASSERT_TRUE(profile) << describe(profile.error());
  EXPECT_EQ(profile->name, "Some camera");
  EXPECT_EQ(profile->models.size(), 2U);
  EXPECT_EQ(profile->depth_units_per_m, 8000.0);
  EXPECT_EQ(profile->near_mm, 200.0);
  EXPECT_EQ(profile->far_mm, 1500.0);
  EXPECT_EQ(profile->warm_up_s, 60.0);
  EXPECT_EQ(profile->depth->fy_px, 601.0);
  EXPECT_EQ(profile->correction.scale, 1.01);
  EXPECT_EQ(profile->correction.polynomial[1][5], 5.0);
  EXPECT_EQ(profile->correction.polynomial[0][1], 0.0);
  ASSERT_EQ(profile->traps.size(), 1U);
}

TEST(DeviceProfile, WhatMayBeAbsentMay) {
  nlohmann::json least = wholeProfile();
  for (const char* key : {"depth_units_per_m", "depth", "depth_correction", "traps", "more"}) {
    least.erase(key);
  }
  const auto profile = parseDeviceProfile(least.dump(), "least.json");
  ASSERT_TRUE(profile) << describe(profile.error());
  EXPECT_TRUE(profile->correction.isIdentity());
  EXPECT_FALSE(profile->depth);
}

TEST(DeviceProfile, MalformedOnesAreRefusedWithFileAndField) {
  const std::vector<std::pair<std::string, nlohmann::json>> bad = {
      {"name", ""},
      {"name", nullptr},
      {"models", nlohmann::json::array()},
      {"models", {""}},  // would be found in every model
      {"models", "Some"},
      {"range_mm", {1500, 200}},
      {"range_mm", {0, 200}},
      {"range_mm", {200}},
      {"range_mm", "near"},
      {"warm_up_s", -1},
      {"warm_up_s", "a while"},
      {"depth_units_per_m", 0},
      {"depth", {{"width", 640}}},
      {"depth_correction", {{"scale", 1000}}},
      {"traps", {3}}};
  for (const auto& [key, value] : bad) {
    nlohmann::json profile = wholeProfile();
    profile[key] = value;
    const auto parsed = parseDeviceProfile(profile.dump(), "bad.json");
    ASSERT_FALSE(parsed) << key << ' ' << value;
    EXPECT_EQ(parsed.error().code, ErrorCode::CameraFactsInvalid);
    EXPECT_EQ(parsed.error().detail.find("bad.json: "), 0U) << parsed.error().detail;
    EXPECT_NE(parsed.error().detail.find('"'), std::string::npos) << parsed.error().detail;
  }
  for (const char* text : {"", "[]", "3", "{\"name\": "}) {
    EXPECT_FALSE(parseDeviceProfile(text, "bad.json")) << text;
  }
}

TEST(DeviceProfiles, OursAreWholeAndCorrectNothingYet) {
  const std::vector<DeviceProfile> profiles = deviceProfiles();
  EXPECT_EQ(profiles.size(), 7U);
  for (const DeviceProfile& profile : profiles) {
    EXPECT_TRUE(profile.correction.isIdentity()) << profile.name;
    EXPECT_GE(profile.near_mm, 150.0) << profile.name;  // what openScanFolder takes for plausible
    EXPECT_LE(profile.far_mm, 2000.0) << profile.name;
  }
}

TEST(DeviceProfiles, AreFoundByTheModelOfTheCamera) {
  const std::vector<DeviceProfile> profiles = deviceProfiles();
  const auto name = [&](std::string_view model) {
    const DeviceProfile* profile = profileOf(model, profiles);
    return profile != nullptr ? profile->name : std::string();
  };
  EXPECT_EQ(name("Intel RealSense SR300"), "Intel RealSense SR300, SR305");
  EXPECT_EQ(name("intel realsense sr305"), "Intel RealSense SR300, SR305");
  EXPECT_EQ(name("F200"), "Intel RealSense F200");
  // Both are named: the longer text decides, not the order of the files.
  EXPECT_EQ(name("camera of the F200/SR300 class"), "Intel RealSense SR300, SR305");
  EXPECT_EQ(name("Tarsus simulator"), "Tarsus simulator");
  EXPECT_EQ(name("SR30"), "");
  EXPECT_EQ(name(""), "");
}

TEST(DoubtsAboutDepth, BeginOutsideTheLimitsNotOnThem) {
  const DeviceProfile profile = *parseDeviceProfile(wholeProfile().dump(), "some.json");
  EXPECT_TRUE(doubtsAboutDepth("Some", &profile, 200.0, 60.0).empty());
  EXPECT_TRUE(doubtsAboutDepth("Some", &profile, 1500.0, std::nullopt).empty());
  EXPECT_TRUE(doubtsAboutDepth("Some", &profile, std::nullopt, std::nullopt).empty());
  EXPECT_TRUE(doubtsAboutDepth("", nullptr, 10.0, 0.0).empty());
  const Warnings near = doubtsAboutDepth("Some", &profile, 199.0, 59.0);
  ASSERT_EQ(near.size(), 2U);
  EXPECT_EQ(near[0].code, "depth_outside_range");
  EXPECT_NE(near[0].text.find("0.20 m to 1.50 m"), std::string::npos) << near[0].text;
  EXPECT_EQ(near[1].code, "camera_not_warm");
  EXPECT_NE(near[1].text.find("60 s"), std::string::npos) << near[1].text;
  const Warnings unknown = doubtsAboutDepth("Thing", nullptr, 400.0, std::nullopt);
  ASSERT_EQ(unknown.size(), 1U);
  EXPECT_NE(unknown[0].text.find("Thing"), std::string::npos);
}

}  // namespace
}  // namespace tarsus
