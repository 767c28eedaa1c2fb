#pragma once

#include "reconstruction/base/error.h"

#include <filesystem>
#include <string>

namespace tarsus {

/// A whole file in memory, in one read.
/// @errors FileMissing, FileUnreadable (a folder, no rights, too large for the memory)
[[nodiscard]] Expected<std::string> readFileBytes(const std::filesystem::path& path);

}  // namespace tarsus
