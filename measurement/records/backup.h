#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <cstddef>
#include <filesystem>

namespace tarsus {

struct BackupSummary {
  std::size_t rows = 0;
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

/// Copies the store as it stands at one moment while others go on working: records.sqlite whichever
/// engine keeps the tables, the encrypted files, audit.anchor, and manifest.json with the size and
/// SHA-256 of each, read back before it returns. Everything stays encrypted; it opens with the same
/// passwords and recovery code.
/// @param target  a folder that is not there yet, or is empty
/// @errors NotPermitted, BadOption (not empty), FileUnwritable, DiskFull, FileMissing (a file that
/// a record uses; the backup is not made)
[[nodiscard]] Expected<BackupSummary> backUp(Store& store, const std::filesystem::path& target);

/// Compares each file of a backup with its manifest. Needs no password.
/// @errors FileMissing, FileUnreadable, StoreDamaged (naming the file)
[[nodiscard]] Expected<BackupSummary> verifyBackup(const std::filesystem::path& backup);

/// Makes a store of a verified backup; on a server, in a database without tables.
/// @param place  an empty folder, or one that is not there yet
/// @errors those of verifyBackup, BadOption (there is a store already), those of Database
[[nodiscard]] Expected<BackupSummary> restore(const std::filesystem::path& backup,
                                              const StorePlace& place);

}  // namespace tarsus
