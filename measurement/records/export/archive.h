#pragma once

#include "measurement/records/export/export.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace tarsus {

/// Writes manifest.json: name, size and SHA-256 of each file below the folder, in order.
/// @param about  further members
/// @errors FileUnwritable, DiskFull, FileUnreadable
[[nodiscard]] Expected<ExportSummary> writeManifest(const std::filesystem::path& folder,
                                                    nlohmann::json about);

/// Packs all files below a folder; the same files give the same bytes.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> packZip(const std::filesystem::path& folder,
                                     const std::filesystem::path& file);

}  // namespace tarsus
