#include "measurement/wound/measure.h"
#include "tests/measurement/wound/measured.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>

namespace tarsus {
namespace {

TEST(MeasurementJson, HasExactlyTheKeysOfTheFormat) {
  const test::Skin skin = test::planeSkin();
  const test::Relief relief = test::bowl(8.0, 3.0);
  const auto foot = test::woundMesh(skin, relief, {.half_size_mm = 21.0});
  const auto result = test::measured(foot, test::circleOn(skin, relief, 8.0, 40));
  ASSERT_TRUE(result);
  const nlohmann::json json = toJson(result->numbers);
  // design.md section 4; `version` is the caller's.
  const std::set<std::string> expected{"opening_area_mm2",
                                       "bed_area_mm2",
                                       "projected_area_mm2",
                                       "perimeter_mm",
                                       "volume_mm3",
                                       "volume_above_mm3",
                                       "mean_depth_mm",
                                       "max_depth_mm",
                                       "p99_depth_mm",
                                       "max_depth_at_mm",
                                       "length_mm",
                                       "width_mm",
                                       "length_clock_mm",
                                       "width_clock_mm",
                                       "unseen_bed_fraction",
                                       "intervals",
                                       "not_measurable",
                                       "method",
                                       "warnings"};
  std::set<std::string> keys;
  for (const auto& [key, value] : json.items()) {
    keys.insert(key);
  }
  EXPECT_EQ(keys, expected);
  EXPECT_TRUE(json["volume_mm3"].is_number());
  EXPECT_EQ(json["max_depth_at_mm"].size(), 3U);
  EXPECT_TRUE(json["unseen_bed_fraction"].is_null());
  EXPECT_TRUE(json["length_clock_mm"].is_null());
  EXPECT_TRUE(json["not_measurable"]["length_clock_mm"].is_string());
  EXPECT_EQ(json["intervals"]["volume_mm3"].size(), 2U);
  EXPECT_FALSE(json["intervals"].contains("length_clock_mm"));
  EXPECT_NE(json["method"].get<std::string>().find("biconic"), std::string::npos);
}

TEST(MeasurementJson, EmptyValuesAreNull) {
  const nlohmann::json json = toJson(WoundMeasurement{});
  EXPECT_TRUE(json["opening_area_mm2"].is_null());
  EXPECT_TRUE(json["max_depth_at_mm"].is_null());
  EXPECT_TRUE(json["intervals"].is_object());
  EXPECT_TRUE(json["not_measurable"].is_object());
  EXPECT_TRUE(json["warnings"].is_array());
}

}  // namespace
}  // namespace tarsus
