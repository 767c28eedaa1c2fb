#pragma once

#include "measurement/records/database.h"

#include <span>
#include <string_view>

namespace tarsus {

/// A numbered file of migrations/; their table is written by CMake.
struct MigrationText {
  int version = 0;
  std::string_view sql;
};
[[nodiscard]] std::span<const MigrationText> migrationTexts();

/// 0: there are no tables yet.
[[nodiscard]] Expected<std::int64_t> tablesVersion(Database& database);

/// Brings the tables to this program's version, each step in its own transaction.
/// @errors StoreNewer (tables of a later program), those of Database
[[nodiscard]] Expected<void> migrate(Database& database,
                                     std::span<const MigrationText> steps = migrationTexts());

}  // namespace tarsus
