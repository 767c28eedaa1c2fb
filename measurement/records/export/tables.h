#pragma once

#include "measurement/records/export/bundle.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace tarsus {

/// patients.csv, wounds.csv, visits.csv, measurements.csv and records.json.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeTables(const std::filesystem::path& folder,
                                         const ExportBundle& bundle);

/// A cell of a table by RFC 4180; text that a spreadsheet would run gets an apostrophe in front.
[[nodiscard]] std::string csvCell(const nlohmann::json& value);

}  // namespace tarsus
