#include "measurement/comparison/comparison.h"

#include "tests/measurement/comparison/visit_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace tarsus {
namespace {

using test::unevenSkin;
using test::Visit;
using test::visitTo;

WoundMeasurement numbers(double area_mm2, double volume_mm3, double depth_mm, double perimeter_mm) {
  WoundMeasurement m;
  m.opening_area_mm2 = area_mm2;
  m.volume_mm3 = volume_mm3;
  m.max_depth_mm = depth_mm;
  m.perimeter_mm = perimeter_mm;
  m.intervals["opening_area_mm2"] = {area_mm2 - 3.0, area_mm2 + 3.0};
  m.intervals["volume_mm3"] = {volume_mm3 - 40.0, volume_mm3 + 40.0};
  m.intervals["max_depth_mm"] = {depth_mm - 0.1, depth_mm + 0.1};
  m.intervals["perimeter_mm"] = {perimeter_mm - 1.0, perimeter_mm + 1.0};
  return m;
}

class Comparison : public ::testing::Test {
 protected:
  Comparison() {
    a_.landmarks = Landmarks{{-150.0, 0.0, -60.0}, {100.0, 0.0, -60.0}};
    b_.landmarks = a_.landmarks;
  }
  [[nodiscard]] nlohmann::json compared(const std::optional<double>& days) const {
    const auto result = compareVisits({a_.surface(), earlier_}, {b_.surface(), later_}, days);
    EXPECT_TRUE(result) << (result ? "" : result.error().detail);
    return result ? toJson(*result) : nlohmann::json::object();
  }

  Visit a_ = visitTo(unevenSkin(3), {.radius_mm = 12.0, .depth_mm = 3.0, .seed = 1});
  Visit b_ = visitTo(unevenSkin(3), {.radius_mm = 9.0, .depth_mm = 3.0, .seed = 2});
  WoundMeasurement earlier_ = numbers(400.0, 1000.0, 3.0, 70.0);
  WoundMeasurement later_ = numbers(300.0, 970.0, 2.95, 60.0);
};

TEST_F(Comparison, HoldsWhatTheFormatAsksFor) {
  const auto json = compared(14.0);
  EXPECT_TRUE(json.at("accepted").get<bool>());
  EXPECT_TRUE(json.at("refusal").is_null());
  EXPECT_DOUBLE_EQ(json.at("area_change_percent"), -25.0);
  EXPECT_DOUBLE_EQ(json.at("volume_change_percent"), -3.0);
  EXPECT_NEAR(json.at("max_depth_change_mm").get<double>(), -0.05, 1e-12);
  EXPECT_DOUBLE_EQ(json.at("par_percent"), 25.0);
  EXPECT_NEAR(json.at("gilman_mm_per_week").get<double>(), 200.0 / 130.0 / 2.0, 1e-12);
  EXPECT_NEAR(json.at("rate_per_week").get<double>(), std::log(4.0 / 3.0) / 2.0, 1e-12);
  EXPECT_GT(json.at("limit_of_detection_mm").get<double>(), 0.2);
  EXPECT_LT(json.at("limit_of_detection_mm").get<double>(), 0.5);
  EXPECT_EQ(json.at("b_from_a").size(), 4U);
  ASSERT_EQ(json.at("sectors").size(), 12U);
  for (const auto& sector : json.at("sectors")) {
    EXPECT_NEAR(sector.at("edge_mm").get<double>(), 3.0, 0.6) << sector.at("clock");
    EXPECT_GT(sector.at("gain_mm3").get<double>(), 5.0);
  }
}

TEST_F(Comparison, ToldChangesAreThoseAboveTheSmallestDetectable) {
  const auto json = compared(14.0);
  const auto& changes = json.at("changes");
  EXPECT_TRUE(changes.at("opening_area_mm2").at("detectable").get<bool>());
  EXPECT_NEAR(changes.at("opening_area_mm2").at("sdc").get<double>(), std::sqrt(18.0), 1e-12);
  EXPECT_FALSE(changes.at("volume_mm3").at("detectable").get<bool>());
  EXPECT_FALSE(changes.at("max_depth_mm").at("detectable").get<bool>());
}

TEST_F(Comparison, NoRatesByTimeWithoutDays) {
  const auto json = compared({});
  EXPECT_TRUE(json.at("gilman_mm_per_week").is_null());
  EXPECT_TRUE(json.at("rate_per_week").is_null());
  EXPECT_DOUBLE_EQ(json.at("par_percent"), 25.0);
}

TEST_F(Comparison, DaysMustPass) {
  for (const double days : {0.0, -3.0, std::nan("")}) {
    const auto result = compareVisits({a_.surface(), earlier_}, {b_.surface(), later_}, days);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::BadOption);
  }
}

TEST_F(Comparison, NumbersStayWhereTheRegistrationIsRefused) {
  b_ = visitTo(unevenSkin(8), {.radius_mm = 9.0, .seed = 2});
  const auto json = compared(14.0);
  EXPECT_FALSE(json.at("accepted").get<bool>());
  EXPECT_TRUE(json.at("refusal").is_string());
  EXPECT_TRUE(json.at("sectors").is_null());
  EXPECT_TRUE(json.at("limit_of_detection_mm").is_null());
  EXPECT_TRUE(json.at("b_from_a").is_null());
  EXPECT_DOUBLE_EQ(json.at("area_change_percent"), -25.0);
}

TEST_F(Comparison, NumbersStayWhereTooLittleWasScanned) {
  b_ = visitTo(unevenSkin(3), {.radius_mm = 9.0, .half_size_mm = 15.0, .seed = 2});
  const auto json = compared(14.0);
  EXPECT_FALSE(json.at("accepted").get<bool>());
  EXPECT_TRUE(json.at("rms_residual_mm").is_null());
  EXPECT_DOUBLE_EQ(json.at("area_change_percent"), -25.0);
}

TEST_F(Comparison, WhatOneVisitCouldNotMeasureIsNotCompared) {
  later_.not_measurable["volume_mm3"] = "30 % of the wound bed was not seen by the camera";
  const auto json = compared(14.0);
  EXPECT_TRUE(json.at("volume_change_percent").is_null());
  EXPECT_EQ(json.at("not_measurable").at("volume_mm3"),
            "later visit: 30 % of the wound bed was not seen by the camera");
  EXPECT_FALSE(json.at("changes").contains("volume_mm3"));
}

TEST_F(Comparison, NoClockWithoutLandmarks) {
  a_.landmarks.reset();
  b_.landmarks.reset();
  const auto json = compared(14.0);
  EXPECT_TRUE(json.at("accepted").get<bool>());
  EXPECT_TRUE(json.at("sectors").is_null());
  EXPECT_TRUE(json.at("why_no_sectors").is_string());
}

TEST_F(Comparison, EarlierLandmarksServeTheLaterVisit) {
  b_.landmarks.reset();
  EXPECT_EQ(compared(14.0).at("sectors").size(), 12U);
}

}  // namespace
}  // namespace tarsus
