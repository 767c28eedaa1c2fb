#include "measurement/comparison/healing_rates.h"

#include "reconstruction/base/require.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kDaysPerWeek = 7.0;
constexpr int kFewestForFit = 3;
constexpr int kFewestForExtrapolation = 5;

double halfWidth(const Interval& interval) { return 0.5 * (interval.high - interval.low); }

}  // namespace

std::optional<double> percentAreaReduction(double first_mm2, double now_mm2) {
  if (!(first_mm2 > 0.0)) {
    return std::nullopt;
  }
  return 100.0 * (first_mm2 - now_mm2) / first_mm2;
}

std::optional<double> gilmanAdvance(const WoundSize& earlier, const WoundSize& later, double days) {
  const double edges_mm = earlier.perimeter_mm + later.perimeter_mm;
  if (!(days > 0.0) || !(edges_mm > 0.0)) {
    return std::nullopt;
  }
  return 2.0 * (earlier.area_mm2 - later.area_mm2) / edges_mm * kDaysPerWeek / days;
}

std::optional<double> exponentialRate(double first_mm2, double now_mm2, double days) {
  if (!(days > 0.0) || !(first_mm2 > 0.0) || !(now_mm2 > 0.0)) {
    return std::nullopt;
  }
  return std::log(first_mm2 / now_mm2) * kDaysPerWeek / days;
}

std::optional<ExponentialFit> fitExponential(std::span<const SeriesVisit> visits) {
  std::vector<SeriesVisit> open;
  std::ranges::copy_if(
      visits, std::back_inserter(open), [](const auto& v) { return v.size.area_mm2 > 0.0; });
  const auto n = static_cast<double>(open.size());
  if (open.size() < kFewestForFit) {
    return std::nullopt;
  }
  double mean_day = 0.0;
  double mean_log = 0.0;
  for (const SeriesVisit& v : open) {
    mean_day += v.days / n;
    mean_log += std::log(v.size.area_mm2) / n;
  }
  double spread = 0.0;
  double product = 0.0;
  for (const SeriesVisit& v : open) {
    spread += (v.days - mean_day) * (v.days - mean_day);
    product += (v.days - mean_day) * (std::log(v.size.area_mm2) - mean_log);
  }
  if (!(spread > 0.0)) {
    return std::nullopt;
  }
  const double slope = product / spread;
  double squares = 0.0;
  for (const SeriesVisit& v : open) {
    const double rest = std::log(v.size.area_mm2) - mean_log - slope * (v.days - mean_day);
    squares += rest * rest;
  }
  const double freedom = n - 2.0;
  const double quantile = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  const double half = quantile * std::sqrt(squares / freedom / spread) * kDaysPerWeek;
  const double rate = -slope * kDaysPerWeek;
  const auto days = std::ranges::minmax(open, {}, &SeriesVisit::days);
  return ExponentialFit{.start_mm2 = std::exp(mean_log - slope * mean_day),
                        .rate_per_week = rate,
                        .rate_interval = {rate - half, rate + half},
                        .visits = static_cast<int>(open.size()),
                        .first_day = days.min.days,
                        .last_day = days.max.days};
}

std::optional<double> areaOn(const ExponentialFit& fit, double day) {
  const bool within = day >= fit.first_day && day <= fit.last_day;
  const bool beyond = day > fit.last_day && fit.visits >= kFewestForExtrapolation;
  if (!within && !beyond) {
    return std::nullopt;
  }
  return fit.start_mm2 * std::exp(-fit.rate_per_week * day / kDaysPerWeek);
}

double smallestDetectableChange(const Interval& earlier, const Interval& later) {
  return std::hypot(halfWidth(earlier), halfWidth(later));
}

Change changeOf(double earlier,
                const std::optional<Interval>& earlier_interval,
                double later,
                const std::optional<Interval>& later_interval) {
  Change change;
  change.value = later - earlier;
  if (earlier != 0.0) {
    change.percent = 100.0 * change.value / earlier;
  }
  if (earlier_interval && later_interval) {
    change.sdc = smallestDetectableChange(*earlier_interval, *later_interval);
    change.detectable = std::abs(change.value) > *change.sdc;
  }
  return change;
}

HealingSeries healingSeries(std::span<const SeriesVisit> visits) {
  TARSUS_REQUIRE(std::ranges::is_sorted(visits, {}, &SeriesVisit::days),
                 "visits come in the order of their days");
  HealingSeries series;
  series.steps.resize(visits.size());
  for (std::size_t i = 1; i < visits.size(); ++i) {
    const SeriesVisit& first = visits[0];
    const SeriesVisit& before = visits[i - 1];
    const SeriesVisit& now = visits[i];
    SeriesStep& step = series.steps[i];
    step.par_percent = percentAreaReduction(first.size.area_mm2, now.size.area_mm2);
    step.gilman_mm_per_week = gilmanAdvance(before.size, now.size, now.days - before.days);
    step.rate_per_week =
        exponentialRate(first.size.area_mm2, now.size.area_mm2, now.days - first.days);
  }
  series.fit = fitExponential(visits);
  return series;
}

}  // namespace tarsus
