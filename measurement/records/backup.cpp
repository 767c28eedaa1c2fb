#include "measurement/records/backup.h"

#include "measurement/records/audit.h"
#include "measurement/records/migrations.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/sha256.h"

#include <nlohmann/json.hpp>

#include <array>
#include <fstream>
#include <system_error>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kManifest = "manifest.json";
constexpr const char* kTables = "records.sqlite";
constexpr const char* kAnchor = "audit.anchor";

struct Table {
  const char* name;
  const char* columns;
  const char* order;  ///< for reading piece by piece; unique
  std::size_t count;
};

/// Parents before children.
constexpr std::array kCopied{
    Table{"records", "id, kind, parent, revision, entry, state, trashed", "id", 7},
    Table{"revisions",
          "record, revision, entry, parent, state, trashed, at_ms, author, station, action, sealed",
          "entry",
          11},
    Table{"file_use", "file, record", "file, record", 2},
    Table{"audit",
          "entry, at_ms, who, station, action, subject, revision, digest, details, hash",
          "entry",
          10},
    Table{"key_wrap",
          "holder, user_record, salt, operations, memory_bytes, sealed, failures, last_failure_ms",
          "holder",
          8},
};

Expected<std::size_t> copyTable(Database& from, Database& to, const Table& table) {
  constexpr std::int64_t kAtOnce = 5000;
  std::string places = "?";
  for (std::size_t i = 1; i < table.count; ++i) {
    places += ", ?";
  }
  const std::string insert =
      std::string("INSERT INTO ") + table.name + " (" + table.columns + ") VALUES (" + places + ")";
  const std::string select = std::string("SELECT ") + table.columns + " FROM " + table.name +
                             " ORDER BY " + table.order + " LIMIT ? OFFSET ?";
  std::size_t copied = 0;
  for (bool more = true; more;) {
    const auto rows = from.query(select, {kAtOnce, static_cast<std::int64_t>(copied)});
    if (!rows) {
      return tl::unexpected(rows.error());
    }
    for (const SqlRow& row : *rows) {
      if (const auto written = to.execute(insert, row.values()); !written) {
        return tl::unexpected(written.error());
      }
    }
    more = !rows->empty();
    copied += rows->size();
  }
  return copied;
}

/// @param to  with tables and no rows
Expected<std::size_t> copyTables(Database& from, Database& to) {
  auto frozen = Transaction::beginSnapshot(from);
  if (!frozen) {
    return tl::unexpected(frozen.error());
  }
  auto filling = Transaction::begin(to);
  if (!filling) {
    return tl::unexpected(filling.error());
  }
  std::size_t rows = 0;
  for (const Table& table : kCopied) {
    const auto copied = copyTable(from, to, table);
    if (!copied) {
      return copied;
    }
    rows += *copied;
  }
  const auto done = filling->commit();
  return done ? Expected<std::size_t>(rows) : tl::unexpected(done.error());
}

Expected<void> requireEmpty(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error)) {
    return fail(ErrorCode::BadOption, folder.string() + " must be an empty folder or a new one");
  }
  fs::create_directories(folder, error);
  return error ? Expected<void>(
                     fail(ErrorCode::FileUnwritable, folder.string() + ": " + error.message()))
               : Expected<void>();
}

Expected<void> copyFile(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::is_regular_file(from, error)) {
    return fail(ErrorCode::FileMissing, from.string() + " is missing; restore this file");
  }
  return writeFileAtomically(to, [&](const fs::path& temporary) -> Expected<void> {
    std::error_code failed;
    fs::copy_file(from, temporary, fs::copy_options::overwrite_existing, failed);
    if (failed) {
      const bool full = failed == std::errc::no_space_on_device;
      return fail(full ? ErrorCode::DiskFull : ErrorCode::FileUnwritable,
                  temporary.string() + ": " + failed.message());
    }
    return {};
  });
}

Expected<void> writeManifest(const fs::path& folder, const std::vector<fs::path>& files) {
  json list = json::array();
  for (const fs::path& file : files) {
    const auto sum = sha256OfFile(folder / file);
    if (!sum) {
      return tl::unexpected(sum.error());
    }
    list.push_back({{"path", file.generic_string()},
                    {"bytes", fs::file_size(folder / file)},
                    {"sha256", *sum}});
  }
  const json manifest = {{"format", "tarsus-backup-1"}, {"files", list}};
  return writeTextAtomically(folder / kManifest, manifest.dump(1) + "\n");
}

struct Entry {
  fs::path path;
  std::uintmax_t bytes = 0;
  std::string sha256;
};

/// A path of a manifest stays inside its folder.
bool isInside(const fs::path& path) {
  return path.is_relative() && path.lexically_normal() == path && *path.begin() != "..";
}

Expected<std::vector<Entry>> readManifest(const fs::path& folder) {
  const auto text = readTextFile(folder / kManifest);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const fs::path name = folder / kManifest;
  try {
    const json manifest = json::parse(*text);
    if (manifest.at("format") != "tarsus-backup-1") {
      return fail(ErrorCode::StoreNewer, name.string() + " has another format");
    }
    std::vector<Entry> entries;
    for (const json& file : manifest.at("files")) {
      entries.push_back({.path = file.at("path").get<std::string>(),
                         .bytes = file.at("bytes").get<std::uintmax_t>(),
                         .sha256 = file.at("sha256").get<std::string>()});
      if (entries.back().path.empty() || !isInside(entries.back().path)) {
        return fail(ErrorCode::StoreDamaged, name.string());
      }
    }
    return entries;
  } catch (const json::exception& exception) {
    return fail(ErrorCode::StoreDamaged, name.string() + ": " + exception.what());
  }
}

/// The tables of the store in a fresh SQLite file without a log beside it.
Expected<std::size_t> writeTables(Store& store, const fs::path& file) {
  auto copy = Database::openSqlite(file);
  if (!copy) {
    return tl::unexpected(copy.error());
  }
  if (auto migrated = migrate(*copy); !migrated) {
    return tl::unexpected(migrated.error());
  }
  auto rows = copyTables(store.database(), *copy);
  if (!rows) {
    return rows;
  }
  if (auto anchored = writeAuditAnchor(*copy, file.parent_path() / kAnchor, AnchorStep::Begin);
      !anchored) {
    return tl::unexpected(anchored.error());
  }
  // One file, whole in itself: the journal's mode is kept in it.
  const auto closed = copy->query("PRAGMA journal_mode = DELETE");
  return closed ? rows : tl::unexpected(closed.error());
}

Expected<std::vector<fs::path>> copyUsedFiles(Store& store, const fs::path& target) {
  // Read from the copy, so that tables and files are of the same moment.
  auto copy = Database::openSqlite(target / kTables);
  if (!copy) {
    return tl::unexpected(copy.error());
  }
  const auto rows = copy->query("SELECT DISTINCT file FROM file_use ORDER BY file");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  std::vector<fs::path> files;
  for (const SqlRow& row : *rows) {
    const FileStore kept("files");
    if (auto whole = store.files().verify(store.vault(), row.text(0)); !whole) {
      return tl::unexpected(whole.error());
    }
    const fs::path relative = kept.pathOf(row.text(0));
    if (auto copied = copyFile(store.files().pathOf(row.text(0)), target / relative); !copied) {
      return tl::unexpected(copied.error());
    }
    files.push_back(relative);
  }
  const auto closed = copy->query("PRAGMA journal_mode = DELETE");
  return closed ? Expected<std::vector<fs::path>>(std::move(files))
                : tl::unexpected(closed.error());
}

Expected<void> fillServer(const fs::path& backup, const PostgresAddress& address) {
  auto from = Database::openSqlite(backup / kTables);
  auto to = Database::openPostgres(address);
  if (!from || !to) {
    return tl::unexpected(!from ? from.error() : to.error());
  }
  if (auto migrated = migrate(*from).and_then([&] { return migrate(*to); }); !migrated) {
    return migrated;
  }
  const auto present = to->query("SELECT holder FROM key_wrap LIMIT 1");
  if (!present || !present->empty()) {
    return present ? fail(ErrorCode::BadOption, "the database holds records already")
                   : tl::unexpected(present.error());
  }
  const auto copied = copyTables(*from, *to);
  return copied ? Expected<void>() : tl::unexpected(copied.error());
}

}  // namespace

Expected<BackupSummary> backUp(Store& store, const fs::path& target) {
  if (auto who = store.who(Permission::BackUp); !who) {
    return tl::unexpected(who.error());
  }
  std::error_code unknown;
  const fs::path own = fs::weakly_canonical(store.anchorFile().parent_path(), unknown);
  const fs::path inside = fs::weakly_canonical(target, unknown).lexically_relative(own);
  if (!inside.empty() && *inside.begin() != "..") {
    return fail(
        ErrorCode::BadOption,
        target.string() + " lies inside the records themselves; a backup belongs elsewhere");
  }
  if (auto empty = requireEmpty(target); !empty) {
    return tl::unexpected(empty.error());
  }
  if (auto noted = noteAct(store, Permission::BackUp, "back up"); !noted) {
    return tl::unexpected(noted.error());
  }
  const auto rows = writeTables(store, target / kTables);
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  auto files = copyUsedFiles(store, target);
  if (!files) {
    return tl::unexpected(files.error());
  }
  files->insert(files->begin(), {kTables, kAnchor});
  // The manifest comes last: a folder without one is no backup.
  if (auto written = writeManifest(target, *files); !written) {
    return tl::unexpected(written.error());
  }
  auto summary = verifyBackup(target);
  if (summary) {
    summary->rows = *rows;
  }
  return summary;
}

Expected<BackupSummary> verifyBackup(const fs::path& backup) {
  const auto entries = readManifest(backup);
  if (!entries) {
    return tl::unexpected(entries.error());
  }
  BackupSummary summary;
  for (const Entry& entry : *entries) {
    const auto sum = sha256OfFile(backup / entry.path);
    if (!sum) {
      return tl::unexpected(sum.error());
    }
    if (*sum != entry.sha256) {
      return fail(ErrorCode::StoreDamaged,
                  (backup / entry.path).string() + " is not as it was backed up");
    }
    ++summary.files;
    summary.bytes += entry.bytes;
  }
  return summary;
}

Expected<BackupSummary> restore(const fs::path& backup, const StorePlace& place) {
  const auto summary = verifyBackup(backup);
  const auto entries = readManifest(backup);
  if (!summary || !entries) {
    return tl::unexpected(!summary ? summary.error() : entries.error());
  }
  if (auto empty = requireEmpty(place.folder); !empty) {
    return tl::unexpected(empty.error());
  }
  for (const Entry& entry : *entries) {
    auto copied = copyFile(backup / entry.path, place.folder / entry.path);
    const auto sum = copied.and_then([&] { return sha256OfFile(place.folder / entry.path); });
    if (!sum || *sum != entry.sha256) {
      return sum ? fail(ErrorCode::StoreDamaged, (place.folder / entry.path).string())
                 : tl::unexpected(sum.error());
    }
  }
  if (place.postgres) {  // from the copy, so that the backup may lie on read-only media
    auto filled = fillServer(place.folder, *place.postgres);
    std::error_code ignored;
    fs::remove(place.folder / kTables, ignored);
    if (!filled) {
      return tl::unexpected(filled.error());
    }
  }
  return summary;
}

}  // namespace tarsus
