// Truth: circles, whose area and edge are known, and series made of the very formulas.
#include "measurement/comparison/healing_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace tarsus {
namespace {

WoundSize circle(double radius_mm) {
  return {.area_mm2 = std::numbers::pi * radius_mm * radius_mm,
          .perimeter_mm = 2.0 * std::numbers::pi * radius_mm};
}

std::vector<SeriesVisit> exponential(int visits, double rate_per_week) {
  std::vector<SeriesVisit> series;
  for (int i = 0; i < visits; ++i) {
    const double days = 10.0 * i + i * i;  // uneven
    series.push_back({days, {.area_mm2 = 400.0 * std::exp(-rate_per_week * days / 7.0)}});
  }
  return series;
}

TEST(HealingRates, AreaReductionOfKnownAreas) {
  EXPECT_DOUBLE_EQ(percentAreaReduction(400.0, 100.0).value(), 75.0);
  EXPECT_DOUBLE_EQ(percentAreaReduction(400.0, 500.0).value(), -25.0);
  EXPECT_DOUBLE_EQ(percentAreaReduction(400.0, 0.0).value(), 100.0);
  EXPECT_FALSE(percentAreaReduction(0.0, 10.0));
}

TEST(HealingRates, GilmanOfCirclesIsTheChangeOfRadius) {
  // 2 pi (r1^2 - r2^2) / (2 pi (r1 + r2)) = r1 - r2.
  EXPECT_NEAR(gilmanAdvance(circle(12.0), circle(9.0), 7.0).value(), 3.0, 1e-12);
  EXPECT_NEAR(gilmanAdvance(circle(12.0), circle(9.0), 21.0).value(), 1.0, 1e-12);
  EXPECT_NEAR(gilmanAdvance(circle(9.0), circle(12.0), 7.0).value(), -3.0, 1e-12);
  EXPECT_NEAR(gilmanAdvance(circle(9.0), {}, 7.0).value(), 9.0, 1e-12);
  EXPECT_FALSE(gilmanAdvance(circle(9.0), circle(8.0), 0.0));
  EXPECT_FALSE(gilmanAdvance({}, {}, 7.0));
}

TEST(HealingRates, RateOfAnExponential) {
  EXPECT_NEAR(exponentialRate(400.0, 400.0 / std::numbers::e, 7.0).value(), 1.0, 1e-12);
  EXPECT_NEAR(exponentialRate(400.0, 400.0 * std::exp(-0.6), 42.0).value(), 0.1, 1e-12);
  EXPECT_FALSE(exponentialRate(400.0, 0.0, 7.0));
  EXPECT_FALSE(exponentialRate(400.0, 100.0, 0.0));
}

TEST(HealingRates, FitFindsAnExactExponential) {
  const auto fit = fitExponential(exponential(6, 0.15));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->start_mm2, 400.0, 1e-9);
  EXPECT_NEAR(fit->rate_per_week, 0.15, 1e-12);
  EXPECT_NEAR(fit->rate_interval.low, 0.15, 1e-6);
  EXPECT_NEAR(fit->rate_interval.high, 0.15, 1e-6);
}

TEST(HealingRates, IntervalOfTheRateByStudentsT) {
  // ln A = 0, 1, 0 on days 0, 7, 14: slope 0, rest -1/3, 2/3, -1/3, so that
  // s^2 = (6/9) / 1, spread 98 days^2, half-width 12.7062 sqrt(2/3/98) per day.
  const std::vector<SeriesVisit> visits{
      {0.0, {.area_mm2 = 1.0}}, {7.0, {.area_mm2 = std::numbers::e}}, {14.0, {.area_mm2 = 1.0}}};
  const auto fit = fitExponential(visits);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->rate_per_week, 0.0, 1e-12);
  EXPECT_NEAR(fit->rate_interval.high, 7.0 * 12.7062047 * std::sqrt(2.0 / 3.0 / 98.0), 1e-5);
  EXPECT_NEAR(fit->rate_interval.low, -fit->rate_interval.high, 1e-12);
}

TEST(HealingRates, NoFitOfTwoVisitsAndNoExtrapolationOfFour) {
  EXPECT_FALSE(fitExponential(exponential(2, 0.1)));
  auto healed = exponential(3, 0.1);
  healed.back().size.area_mm2 = 0.0;  // two open ones are left
  EXPECT_FALSE(fitExponential(healed));
  std::vector<SeriesVisit> one_day(4, {.days = 3.0, .size = circle(5.0)});
  EXPECT_FALSE(fitExponential(one_day));

  const auto four = fitExponential(exponential(4, 0.1));
  const auto five = fitExponential(exponential(5, 0.1));
  ASSERT_TRUE(four && five);
  EXPECT_FALSE(areaOn(*four, four->last_day + 1.0));
  EXPECT_TRUE(areaOn(*four, four->last_day));
  EXPECT_NEAR(areaOn(*five, 70.0).value(), 400.0 * std::exp(-1.0), 1e-9);
  EXPECT_FALSE(areaOn(*five, -1.0));
}

TEST(HealingRates, ChangeIsRealAboveTheSmallestDetectable) {
  const Interval earlier{97.0, 103.0};  // h = 3
  const Interval later{86.0, 94.0};     // h = 4, so that SDC = 5
  const Change change = changeOf(100.0, earlier, 90.0, later);
  EXPECT_DOUBLE_EQ(change.value, -10.0);
  EXPECT_DOUBLE_EQ(change.percent.value(), -10.0);
  EXPECT_DOUBLE_EQ(change.sdc.value(), 5.0);
  EXPECT_TRUE(change.detectable.value());
  EXPECT_FALSE(changeOf(100.0, earlier, 95.0, later).detectable.value());  // not above
  EXPECT_FALSE(changeOf(100.0, earlier, 90.0, {}).detectable);
  EXPECT_FALSE(changeOf(0.0, earlier, 90.0, later).percent);
}

TEST(HealingRates, SeriesComparesWithTheFirstAndTheOneBefore) {
  const std::vector<SeriesVisit> visits{
      {0.0, circle(12.0)}, {7.0, circle(10.0)}, {21.0, circle(6.0)}};
  const HealingSeries series = healingSeries(visits);
  ASSERT_EQ(series.steps.size(), 3U);
  EXPECT_FALSE(series.steps[0].par_percent);
  EXPECT_NEAR(series.steps[1].gilman_mm_per_week.value(), 2.0, 1e-12);
  EXPECT_NEAR(series.steps[2].gilman_mm_per_week.value(), 2.0, 1e-12);
  EXPECT_NEAR(series.steps[2].par_percent.value(), 75.0, 1e-12);
  EXPECT_NEAR(series.steps[2].rate_per_week.value(), std::log(4.0) / 3.0, 1e-12);
  EXPECT_TRUE(series.fit);
}

TEST(HealingRates, UnorderedSeriesIsACallersMistake) {
  const std::vector<SeriesVisit> visits{{7.0, circle(12.0)}, {0.0, circle(10.0)}};
  EXPECT_THROW((void)healingSeries(visits), std::logic_error);
}

}  // namespace
}  // namespace tarsus
