#pragma once

#include "measurement/records/history.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace tarsus {

// Records as they are shown by the command line and exported; keys as the fields are named.

[[nodiscard]] nlohmann::json toJson(const Patient& patient);
[[nodiscard]] nlohmann::json toJson(const Foot& foot);
[[nodiscard]] nlohmann::json toJson(const Wound& wound);
[[nodiscard]] nlohmann::json toJson(const Visit& visit);
[[nodiscard]] nlohmann::json toJson(const Measurement& measurement);

/// ISO 8601, UTC, whole seconds; empty for 0.
[[nodiscard]] std::string isoTime(std::int64_t at_ms);
/// 2026-10-05, 2026-10-05T09:30 or 2026-10-05T09:30:00Z, UTC.
/// @return milliseconds since 1970
/// @errors BadOption
[[nodiscard]] Expected<std::int64_t> millisecondsOf(std::string_view iso_time);

}  // namespace tarsus
