#pragma once

#include "measurement/wound/bed.h"
#include "measurement/wound/extents.h"
#include "measurement/wound/measure.h"
#include "measurement/wound/reference_skin.h"

#include <map>
#include <optional>
#include <span>
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

/// Length of the outline on the surface with the given depths of the bed's vertices. Relief finer
/// than 3 mm is smoothed along the skin's normal: noise and the facets of a sharp rim make any way
/// over them 1 to 2 % longer, while the course of the curve on the skin stays as it was traced.
[[nodiscard]] double perimeterOf(const Bed& bed,
                                 const BedDepths& depths,
                                 std::span<const double> depth_mm);

/// The projected outline of a bed, seen from outside.
[[nodiscard]] FlatOutline flatOutline(const Bed& bed, const BedDepths& depths);

}  // namespace tarsus
