#pragma once

#include "app/cli/wound_arguments.h"

#include <filesystem>
#include <string>

namespace tarsus {

/// Writes the PDF of one measured wound, with what reconstruction.json beside the model says of the
/// scan's quality, where it is there.
/// @param title  who, which wound, which scan
/// @errors FontMissing, FileUnwritable, DiskFull
[[nodiscard]] Expected<void> printReport(const std::filesystem::path& pdf,
                                         const MeasuredModel& measured,
                                         const std::filesystem::path& model_file,
                                         const std::string& title);

}  // namespace tarsus
