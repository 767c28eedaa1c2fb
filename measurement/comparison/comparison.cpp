#include "measurement/comparison/comparison.h"

#include <array>
#include <cmath>

namespace tarsus {
namespace {

using Number = std::optional<double> WoundMeasurement::*;

struct Quantity {
  const char* name;
  Number number;
};

constexpr std::array kQuantities{
    Quantity{"opening_area_mm2", &WoundMeasurement::opening_area_mm2},
    Quantity{"bed_area_mm2", &WoundMeasurement::bed_area_mm2},
    Quantity{"projected_area_mm2", &WoundMeasurement::projected_area_mm2},
    Quantity{"perimeter_mm", &WoundMeasurement::perimeter_mm},
    Quantity{"volume_mm3", &WoundMeasurement::volume_mm3},
    Quantity{"volume_above_mm3", &WoundMeasurement::volume_above_mm3},
    Quantity{"mean_depth_mm", &WoundMeasurement::mean_depth_mm},
    Quantity{"max_depth_mm", &WoundMeasurement::max_depth_mm},
    Quantity{"p99_depth_mm", &WoundMeasurement::p99_depth_mm},
    Quantity{"length_mm", &WoundMeasurement::length_mm},
    Quantity{"width_mm", &WoundMeasurement::width_mm},
    Quantity{"length_clock_mm", &WoundMeasurement::length_clock_mm},
    Quantity{"width_clock_mm", &WoundMeasurement::width_clock_mm}};

std::optional<Interval> intervalOf(const WoundMeasurement& numbers, const std::string& name) {
  const auto it = numbers.intervals.find(name);
  return it != numbers.intervals.end() ? std::optional(it->second) : std::nullopt;
}

/// Why a visit's number cannot be compared, or nothing.
std::optional<std::string> whyMissing(const WoundMeasurement& numbers,
                                      const Quantity& quantity,
                                      const char* visit) {
  const auto reason = numbers.not_measurable.find(quantity.name);
  if (reason != numbers.not_measurable.end()) {
    return std::string(visit) + " visit: " + reason->second;
  }
  if (!(numbers.*quantity.number)) {
    return std::string(visit) + " visit: not measured";
  }
  return std::nullopt;
}

void compareNumbers(const WoundMeasurement& a,
                    const WoundMeasurement& b,
                    VisitComparison& comparison) {
  for (const Quantity& quantity : kQuantities) {
    auto reason = whyMissing(a, quantity, "earlier");
    if (!reason) {
      reason = whyMissing(b, quantity, "later");
    }
    if (reason) {
      comparison.not_comparable[quantity.name] = *reason;
      continue;
    }
    comparison.changes[quantity.name] = changeOf(*(a.*quantity.number),
                                                 intervalOf(a, quantity.name),
                                                 *(b.*quantity.number),
                                                 intervalOf(b, quantity.name));
  }
}

void computeRates(const WoundMeasurement& a,
                  const WoundMeasurement& b,
                  const std::optional<double>& days,
                  VisitComparison& comparison) {
  if (!a.opening_area_mm2 || !b.opening_area_mm2) {
    return;
  }
  const WoundSize first{*a.opening_area_mm2, a.perimeter_mm.value_or(0.0)};
  const WoundSize now{*b.opening_area_mm2, b.perimeter_mm.value_or(0.0)};
  comparison.par_percent = percentAreaReduction(first.area_mm2, now.area_mm2);
  if (days) {
    comparison.rate_per_week = exponentialRate(first.area_mm2, now.area_mm2, *days);
    if (a.perimeter_mm && b.perimeter_mm) {
      comparison.gilman_mm_per_week = gilmanAdvance(first, now, *days);
    }
  }
}

/// Landmarks of the later visit, or the earlier one's carried over.
std::optional<Landmarks> landmarksInB(const MeasuredVisit& a,
                                      const MeasuredVisit& b,
                                      const Registration& registration) {
  if (b.surface.landmarks || !a.surface.landmarks) {
    return b.surface.landmarks;
  }
  return Landmarks{.heel_mm = registration.b_from_a * a.surface.landmarks->heel_mm,
                   .toe_mm = registration.b_from_a * a.surface.landmarks->toe_mm};
}

void drawMap(const MeasuredVisit& a,
             const MeasuredVisit& b,
             const ChangeMapOptions& options,
             VisitComparison& comparison) {
  if (!comparison.registration.accepted) {
    comparison.why_no_map = "the registration was refused";
    comparison.why_no_sectors = comparison.why_no_map;
    return;
  }
  auto map = mapChange(a.surface, b.surface, comparison.registration, options);
  if (!map) {
    comparison.why_no_map = describe(map.error());
    comparison.why_no_sectors = comparison.why_no_map;
    return;
  }
  comparison.map = std::move(*map);
  const auto landmarks = landmarksInB(a, b, comparison.registration);
  if (!landmarks) {
    comparison.why_no_sectors = "clock directions need the heel and toe landmarks";
    return;
  }
  comparison.sectors = sectorsOf(*comparison.map, *landmarks);
  if (!comparison.sectors) {
    comparison.why_no_sectors = "the foot's axis stands upright on the wound";
  }
}

}  // namespace

Expected<VisitComparison> compareVisits(const MeasuredVisit& a,
                                        const MeasuredVisit& b,
                                        const std::optional<double>& days,
                                        const ComparisonOptions& options) {
  if (days && !(*days > 0.0 && std::isfinite(*days))) {
    return fail(ErrorCode::BadOption, "the days between two visits must be more than 0");
  }
  VisitComparison comparison;
  compareNumbers(a.numbers, b.numbers, comparison);
  computeRates(a.numbers, b.numbers, days, comparison);
  auto registration =
      options.pairs.empty()
          ? registerVisits(a.surface, b.surface, options.registration)
          : registerByPairs(a.surface, b.surface, options.pairs, options.registration);
  if (registration) {
    comparison.registration = std::move(*registration);
    comparison.aligned = true;
  } else if (registration.error().code == ErrorCode::SurfaceIncomplete) {
    comparison.registration.refusal = describe(registration.error());
  } else {
    return tl::unexpected(registration.error());
  }
  drawMap(a, b, options.map, comparison);
  return comparison;
}

}  // namespace tarsus
