#pragma once

#include "measurement/wound/measure.h"

#include <optional>
#include <string>

namespace tarsus {

/// Kinds of printed quantity; each has a greatest number of decimals that its precision earns.
enum class Printed { AreaCm2, VolumeMl, LengthMm, DepthMm, Percent };

/// Decimals of a value from the half-width of its 95 % interval: a leading digit of 1 or 2 keeps
/// two digits of it, any other keeps one; capped per kind; areas always two.
/// @param half_width  in the printed unit; absent or 0: the cap
[[nodiscard]] int printedDecimals(Printed kind, std::optional<double> half_width);

/// Fixed decimals, rounded half away from zero, once, from the stored value; never "-0".
[[nodiscard]] std::string fixedText(double value, int decimals);

/// "1.95-2.53" with an en dash and no spaces.
[[nodiscard]] std::string intervalText(const Interval& interval, double factor, int decimals);

/// "2026-10-05T16:24:00Z" as "5 Oct 2026 16:24 UTC"; any other text as it stands.
[[nodiscard]] std::string dateText(const std::string& iso_8601);

}  // namespace tarsus
