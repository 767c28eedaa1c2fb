#pragma once

#include "reconstruction/base/error.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace tarsus {

/// Records are flushed before the rename, so that a power cut cannot lose them. The thousands of
/// frames of a simulated scan are not: fsync costs milliseconds each.
enum class Flush { ToDisk, Later };

/// Writes a file whole or not at all: `write` fills a temporary file beside `path`, which is
/// flushed to the disk and then renamed over it. Missing parent folders are made. A device or pipe
/// is written to as it is; a link stays a link.
/// @param write  gets the temporary path (same extension); returns its own Error to give up
/// @errors FileUnwritable, DiskFull, and those of `write`; the temporary file is removed
[[nodiscard]] Expected<void> writeFileAtomically(
    const std::filesystem::path& path,
    const std::function<Expected<void>(const std::filesystem::path& temporary)>& write,
    Flush flush = Flush::ToDisk);

/// The same for bytes that are already in memory.
[[nodiscard]] Expected<void> writeFileAtomically(const std::filesystem::path& path,
                                                 std::span<const std::byte> bytes,
                                                 Flush flush = Flush::ToDisk);
[[nodiscard]] Expected<void> writeTextAtomically(const std::filesystem::path& path,
                                                 std::string_view text);

/// Writes bytes to an open-and-close plain file, telling a full disk from other failures.
[[nodiscard]] Expected<void> writeBytes(const std::filesystem::path& path,
                                        std::span<const std::byte> bytes);

/// @errors FileMissing, FileUnreadable
[[nodiscard]] Expected<std::string> readTextFile(const std::filesystem::path& path);

}  // namespace tarsus
