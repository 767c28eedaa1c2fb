#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/pipeline/reconstruct.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string_view>

namespace tarsus {

/// The object of reconstruction.json (design.md section 4).
[[nodiscard]] nlohmann::json toJson(const Reconstruction& reconstruction,
                                    const ScanOptions& options,
                                    std::string_view version);

/// Writes model.ply, trajectory.txt, keyframes/ (a scan folder of the chosen frames with their
/// poses as groundtruth.txt, and all of them in contact.png) and reconstruction.json, the last one
/// last.
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeModelFolder(const std::filesystem::path& folder,
                                              const Reconstruction& reconstruction,
                                              const ScanOptions& options,
                                              std::string_view version);

}  // namespace tarsus
