#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <filesystem>
#include <string>

namespace tarsus {

/// "host=... port=... dbname=... user=...", as PostgreSQL's own programs write it; a password is
/// left to ~/.pgpass. @errors BadOption
[[nodiscard]] Expected<PostgresAddress> postgresAddressOf(const std::string& text);

/// Where this computer's records lie: a file that says so, else the folder "records" beside it.
/// A ward's stations name the same server and the same shared folder, each as it is mounted there.
/// @errors FileUnreadable (the file is there, but makes no sense)
[[nodiscard]] Expected<StorePlace> readStorePlace(const std::filesystem::path& file);
/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeStorePlace(const std::filesystem::path& file,
                                             const StorePlace& place);

}  // namespace tarsus
