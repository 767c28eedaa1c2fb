#include "measurement/records/migrations.h"

#include <string>

namespace tarsus {
namespace {

/// The statements of one file: each ends with ";" at the end of a line; "--" lines are comments.
std::vector<std::string> statementsOf(std::string_view sql) {
  std::vector<std::string> statements;
  std::string statement;
  while (!sql.empty()) {
    const std::size_t end = std::min(sql.find('\n'), sql.size());
    const std::string_view line = sql.substr(0, end);
    sql.remove_prefix(std::min(end + 1, sql.size()));
    if (line.starts_with("--") || line.empty()) {
      continue;
    }
    statement.append(line).push_back('\n');
    if (line.ends_with(';')) {
      statements.push_back(std::move(statement));
      statement.clear();
    }
  }
  return statements;
}

Expected<std::int64_t> versionOf(Database& database) {
  const auto made =
      database.execute("CREATE TABLE IF NOT EXISTS schema_version (version BIGINT PRIMARY KEY)");
  if (!made) {
    return made;
  }
  const auto rows = database.query("SELECT version FROM schema_version ORDER BY version DESC");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  return rows->empty() ? 0 : rows->front().integer(0);
}

/// @return whether there was a step to take
Expected<bool> takeNextStep(Database& database, std::span<const MigrationText> steps) {
  auto transaction = Transaction::begin(database);
  if (!transaction) {
    return tl::unexpected(transaction.error());
  }
  const auto version = versionOf(database);
  if (!version) {
    return tl::unexpected(version.error());
  }
  const std::int64_t latest = steps.empty() ? 0 : steps.back().version;
  if (*version > latest) {
    return fail(ErrorCode::StoreNewer,
                "its tables have version " + std::to_string(*version) + ", this program knows " +
                    std::to_string(latest));
  }
  for (const MigrationText& step : steps) {
    if (step.version <= *version) {
      continue;
    }
    for (const std::string& statement : statementsOf(step.sql)) {
      if (auto done = database.execute(statement); !done) {
        return tl::unexpected(done.error());
      }
    }
    auto noted = database.execute("INSERT INTO schema_version (version) VALUES (?)",
                                  {static_cast<std::int64_t>(step.version)});
    if (!noted) {
      return tl::unexpected(noted.error());
    }
    if (auto done = transaction->commit(); !done) {
      return tl::unexpected(done.error());
    }
    return true;
  }
  if (auto done = transaction->commit(); !done) {
    return tl::unexpected(done.error());
  }
  return false;
}

}  // namespace

Expected<std::int64_t> tablesVersion(Database& database) { return versionOf(database); }

Expected<void> migrate(Database& database, std::span<const MigrationText> steps) {
  Expected<bool> more = true;
  while (more && *more) {
    more = takeNextStep(database, steps);
  }
  return more ? Expected<void>() : tl::unexpected(more.error());
}

}  // namespace tarsus
