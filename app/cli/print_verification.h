#pragma once

#include "measurement/phantom/control_chart.h"
#include "measurement/phantom/verify.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace tarsus {

/// Measured beside true on stdout, and the verdict.
void printVerification(const Phantom& phantom,
                       const Verification& verification,
                       const VerifyLimits& limits);

/// The last results with their control limits, and what of them speaks of a drift.
void printChart(const std::filesystem::path& file, const AppendedChart& appended);

[[nodiscard]] nlohmann::json chartJson(const std::filesystem::path& file,
                                       const AppendedChart& appended);

}  // namespace tarsus
