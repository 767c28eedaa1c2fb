#pragma once

#include "measurement/wound/bed.h"
#include "measurement/wound/extents.h"
#include "measurement/wound/measure.h"
#include "measurement/wound/reference_skin.h"

#include <map>
#include <optional>
#include <string>

namespace tarsus {

/// The measured values by their names in measurement.json; what cannot be measured is not there.
using Quantities = std::map<std::string, double>;

/// Why lengths by the clock cannot be given, or nothing.
[[nodiscard]] std::optional<std::string> whyNoClock(const FlatOutline& outline,
                                                    const std::optional<Landmarks>& landmarks);

[[nodiscard]] Quantities quantitiesOf(const Bed& bed,
                                      const BedDepths& depths,
                                      const std::optional<Landmarks>& landmarks);

/// Standard deviation of each value from the model's own noise, correlated over
/// ReferenceSkinOptions::correlation_area_mm2, in the bed and in the skin fit.
[[nodiscard]] Quantities modelDeviations(const Bed& bed,
                                         const BedDepths& depths,
                                         const ReferenceSkin& skin,
                                         const Quantities& values);

/// The projected outline of a bed, seen from outside.
[[nodiscard]] FlatOutline flatOutline(const Bed& bed, const BedDepths& depths);

}  // namespace tarsus
