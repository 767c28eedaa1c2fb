#pragma once

#include "measurement/comparison/change_map.h"
#include "measurement/comparison/clock_sectors.h"
#include "measurement/comparison/healing_rates.h"
#include "measurement/comparison/registration.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tarsus {

/// One visit's wound with its numbers; what is referred to must outlive it.
struct MeasuredVisit {
  VisitSurface surface;
  const WoundMeasurement& numbers;
};

struct ComparisonOptions {
  RegistrationOptions registration;
  ChangeMapOptions map;
  std::vector<PointPair> pairs;  ///< set by hand, or empty
};

/// Two visits of one wound: b, the later one, less a.
struct VisitComparison {
  Registration registration;
  bool aligned = false;                               ///< false: no alignment was found at all
  std::map<std::string, Change> changes;              ///< by the names of measurement.json
  std::map<std::string, std::string> not_comparable;  ///< the same names -> reason
  std::optional<double> par_percent;
  std::optional<double> gilman_mm_per_week;  ///< empty without days
  std::optional<double> rate_per_week;       ///< ln(A0 / At) / t
  std::optional<ChangeMap> map;              ///< empty where the registration was refused
  std::optional<std::vector<SectorChange>> sectors;
  std::string why_no_map;      ///< empty where there is one
  std::string why_no_sectors;  ///< empty where there are some
};

/// Registration, change of each number, rates, map and sectors. Numbers are compared also where the
/// registration is refused: they need none.
/// @param days  between the visits, > 0; empty: no rates by time
/// @errors OutlineInvalid, BadOption (days, pairs)
[[nodiscard]] Expected<VisitComparison> compareVisits(const MeasuredVisit& a,
                                                      const MeasuredVisit& b,
                                                      const std::optional<double>& days,
                                                      const ComparisonOptions& options = {});

/// comparison.json (design.md section 4), without version and warnings of the caller.
[[nodiscard]] nlohmann::json toJson(const VisitComparison& comparison);

}  // namespace tarsus
