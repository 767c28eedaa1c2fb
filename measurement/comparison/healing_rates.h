#pragma once

#include "measurement/wound/measure.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tarsus {

/// Percent area reduction, 100 (A0 - At) / A0; positive = smaller; nothing where A0 is not > 0.
/// Source: Sheehan et al., Diabetes Care 26(6), 2003: 1879-1882. Group figures, not a prediction.
[[nodiscard]] std::optional<double> percentAreaReduction(double first_mm2, double now_mm2);

/// Area and length of its edge at one visit.
struct WoundSize {
  double area_mm2 = 0.0;
  double perimeter_mm = 0.0;
};

/// Linear advance of the edge towards the middle, D = 2 (A1 - A2) / (P1 + P2), per week; nothing
/// where no time passed or there is no edge.
/// Source: Gilman, Wounds 2(3), 1990: 95-101.
/// @return [mm/week], positive = healing
[[nodiscard]] std::optional<double> gilmanAdvance(const WoundSize& earlier,
                                                  const WoundSize& later,
                                                  double days);

/// Rate of an exponential through two areas, ln(A0 / At) / t; nothing for a closed wound.
/// @return [1/week], positive = healing
[[nodiscard]] std::optional<double> exponentialRate(double first_mm2, double now_mm2, double days);

/// A(t) = A0 exp(-b t), least squares of ln A: equal relative errors at each visit.
struct ExponentialFit {
  double start_mm2 = 0.0;      ///< A0, at day 0
  double rate_per_week = 0.0;  ///< b, positive = healing
  Interval rate_interval;      ///< 95 %, Student's t with visits - 2 degrees of freedom
  int visits = 0;              ///< with an open wound
  double first_day = 0.0;      ///< of them
  double last_day = 0.0;
};

/// One visit of a series.
struct SeriesVisit {
  double days = 0.0;  ///< since any fixed day
  WoundSize size;
};

/// @return  nothing below 3 visits with an open wound, or where all fall on one day
[[nodiscard]] std::optional<ExponentialFit> fitExponential(std::span<const SeriesVisit> visits);

/// The fit's area on a day within the series; beyond its last visit only where it has 5 visits or
/// more: before, an extrapolation says nothing.
/// Source: Cukjati et al., Med. Biol. Eng. Comput. 39(2), 2001: 263-271.
[[nodiscard]] std::optional<double> areaOn(const ExponentialFit& fit, double day);

/// Difference of a number between two visits, later less earlier.
struct Change {
  double value = 0.0;
  std::optional<double> percent;   ///< of the earlier value, empty where that is 0
  std::optional<double> sdc;       ///< smallest detectable change; empty without both intervals
  std::optional<bool> detectable;  ///< |value| > sdc
};

/// SDC = sqrt(h1^2 + h2^2), h the half-widths of both visits' 95 % intervals (clinical.md section
/// 3).
[[nodiscard]] double smallestDetectableChange(const Interval& earlier, const Interval& later);

[[nodiscard]] Change changeOf(double earlier,
                              const std::optional<Interval>& earlier_interval,
                              double later,
                              const std::optional<Interval>& later_interval);

/// One visit of a series beside the first and the one before it; empty for the first.
struct SeriesStep {
  std::optional<double> par_percent;         ///< since the first visit
  std::optional<double> gilman_mm_per_week;  ///< since the visit before
  std::optional<double> rate_per_week;       ///< ln(A0 / At) / t since the first visit
};
struct HealingSeries {
  std::vector<SeriesStep> steps;  ///< #visits
  std::optional<ExponentialFit> fit;
};
/// @param visits  in the order of their days
[[nodiscard]] HealingSeries healingSeries(std::span<const SeriesVisit> visits);

}  // namespace tarsus
