#include "measurement/records/revisions.h"

#include "measurement/records/audit.h"
#include "reconstruction/base/require.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 7> kKindNames{
    "patient", "foot", "wound", "visit", "measurement", "user", "settings"};
constexpr std::array<char, kKindNames.size()> kKindLetters{'P', 'F', 'W', 'V', 'M', 'U', 'S'};

/// The head and the revision are read together, and must say the same.
constexpr const char* kColumns =
    "r.id, r.kind, v.revision, v.entry, v.parent, v.state, v.trashed, v.at_ms, v.author, "
    "v.station, v.action, v.sealed, r.revision, r.entry, r.parent, r.state, r.trashed ";
constexpr const char* kJoin = "JOIN revisions v ON v.record = r.id AND v.revision = r.revision ";

/// A JSON list: no two different rows give the same text.
std::string identityOf(const Revision& revision) {
  const json fields = {revision.record,
                       nameOf(revision.kind),
                       revision.revision,
                       revision.entry,
                       revision.parent,
                       revision.state,
                       revision.trashed,
                       revision.at_ms,
                       revision.author,
                       revision.station,
                       revision.action};
  return fields.dump(-1, ' ', false, json::error_handler_t::replace);
}

tl::unexpected<Error> damaged(const std::string& record, const std::string& what) {
  return fail(ErrorCode::StoreDamaged, "record " + record + ": " + what);
}

Expected<Revision> opened(Store& store, Revision revision, const Bytes& sealed) {
  const auto key = store.vault().key(KeyPurpose::Fields);
  if (!key) {
    return tl::unexpected(key.error());
  }
  const auto plain = openSealed(**key, sealed, identityOf(revision));
  if (!plain) {
    return damaged(revision.record,
                   "revision " + std::to_string(revision.revision) + " is not as it was written");
  }
  json whole = json::parse(*plain, nullptr, false);
  if (!whole.is_object() || !whole.contains("content") || !whole.contains("reason") ||
      !whole["reason"].is_string()) {
    return damaged(revision.record, "its content cannot be read");
  }
  revision.reason = whole["reason"].get<std::string>();
  revision.content = std::move(whole["content"]);
  return revision;
}

Expected<Revision> openedCurrent(Store& store, const SqlRow& row) {
  Revision revision = clearPart(row);
  const bool same = revision.revision == row.integer(12) && revision.entry == row.integer(13) &&
                    revision.parent == row.text(14) && revision.state == row.text(15) &&
                    revision.trashed == (row.integer(16) != 0);
  if (!same) {
    return damaged(revision.record, "its place in the table is not that of its last revision");
  }
  return opened(store, std::move(revision), row.bytes(11));
}

Expected<std::vector<Revision>> readCurrent(Store& store,
                                            const std::string& sql,
                                            const std::vector<SqlValue>& values) {
  const auto rows = store.database().query(sql, values);
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  std::vector<Revision> revisions;
  revisions.reserve(rows->size());
  for (const SqlRow& row : *rows) {
    auto revision = openedCurrent(store, row);
    if (!revision) {
      return tl::unexpected(revision.error());
    }
    revisions.push_back(std::move(*revision));
  }
  return revisions;
}

Expected<void> writeHead(Database& database, const Revision& revision) {
  const auto trashed = static_cast<std::int64_t>(revision.trashed);
  const auto written =
      revision.revision == 1
          ? database.execute(
                "INSERT INTO records (id, kind, parent, revision, entry, state, trashed) VALUES "
                "(?, ?, ?, ?, ?, ?, ?)",
                {revision.record,
                 std::string(nameOf(revision.kind)),
                 revision.parent,
                 revision.revision,
                 revision.entry,
                 revision.state,
                 trashed})
          : database.execute(
                "UPDATE records SET parent = ?, revision = ?, entry = ?, state = ?, trashed = ? "
                "WHERE id = ?",
                {revision.parent,
                 revision.revision,
                 revision.entry,
                 revision.state,
                 trashed,
                 revision.record});
  return written ? Expected<void>() : tl::unexpected(written.error());
}

Expected<void> writeRow(Database& database, const Revision& revision, const Bytes& sealed) {
  const auto written = database.execute(
      "INSERT INTO revisions (record, revision, entry, parent, state, trashed, at_ms, author, "
      "station, action, sealed) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {revision.record,
       revision.revision,
       revision.entry,
       revision.parent,
       revision.state,
       static_cast<std::int64_t>(revision.trashed),
       revision.at_ms,
       revision.author,
       revision.station,
       revision.action,
       sealed});
  return written ? Expected<void>() : tl::unexpected(written.error());
}

/// Names the audit entry that appendAudit will make; both happen in one transaction.
Expected<std::int64_t> nextEntry(Database& database) {
  const auto rows = database.query("SELECT entry FROM audit ORDER BY entry DESC LIMIT 1");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  return rows->empty() ? 1 : rows->front().integer(0) + 1;
}

Expected<Revision> write(Store& store, Revision revision) {
  Database& database = store.database();
  const auto key = store.vault().key(KeyPurpose::Fields);
  const auto entry = nextEntry(database);
  if (!key || !entry) {
    return tl::unexpected(!key ? key.error() : entry.error());
  }
  revision.entry = *entry;
  const json whole = {{"content", revision.content}, {"reason", revision.reason}};
  std::string plain;
  try {
    plain = whole.dump();
  } catch (const json::type_error&) {
    return fail(ErrorCode::RecordInvalid, "a text is not UTF-8");
  }
  const Bytes sealed = seal(**key, plain, identityOf(revision));
  const auto digest = revisionDigest(store.vault(), revision, sealed);
  if (!digest) {
    return tl::unexpected(digest.error());
  }
  auto written =
      writeHead(database, revision).and_then([&] { return writeRow(database, revision, sealed); });
  if (!written) {
    return tl::unexpected(written.error());
  }
  const auto audited =
      appendAudit(database,
                  store.vault(),
                  {.at_ms = revision.at_ms,
                   .who = revision.author,
                   .station = revision.station,
                   .action = std::string(nameOf(revision.kind)) + " " + revision.action,
                   .subject = revision.record,
                   .revision = revision.revision,
                   .digest = *digest,
                   .details = revision.reason});
  if (!audited) {
    return tl::unexpected(audited.error());
  }
  TARSUS_REQUIRE(*audited == revision.entry, "nobody else writes inside a transaction");
  return revision;
}

/// The name of a user for a message; the id where it cannot be read.
std::string userName(Store& store, const std::string& id) {
  const auto user = currentRevision(store, RecordKind::User, id);
  return user && user->content.contains("name") && user->content["name"].is_string()
             ? user->content["name"].get<std::string>()
             : id;
}

tl::unexpected<Error> stale(Store& store, const Revision& current, std::int64_t base_revision) {
  return fail(ErrorCode::RecordStale,
              userName(store, current.author) + " changed it at " + timeText(current.at_ms) +
                  " from " + current.station + ": it is at revision " +
                  std::to_string(current.revision) + ", yours was made on " +
                  std::to_string(base_revision));
}

}  // namespace

Revision clearPart(const SqlRow& row) {
  return {.record = row.text(0),
          .kind = recordKindNamed(row.text(1)).value_or(RecordKind::Settings),
          .revision = row.integer(2),
          .entry = row.integer(3),
          .parent = row.text(4),
          .state = row.text(5),
          .trashed = row.integer(6) != 0,
          .at_ms = row.integer(7),
          .author = row.text(8),
          .station = row.text(9),
          .action = row.text(10)};
}

std::string_view nameOf(RecordKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

std::optional<RecordKind> recordKindNamed(std::string_view name) {
  const auto* const found = std::ranges::find(kKindNames, name);
  return found == kKindNames.end()
             ? std::nullopt
             : std::optional(static_cast<RecordKind>(found - kKindNames.begin()));
}

Expected<Revision> addRecord(Store& store, Revision first) {
  auto change = StoreChange::begin(store, Permission::Read);
  if (!change) {
    return tl::unexpected(change.error());
  }
  if (first.record.empty()) {
    first.record = newId(kKindLetters.at(static_cast<std::size_t>(first.kind)));
  }
  first.revision = 1;
  first.at_ms = store.environment().now_ms();
  first.author = change->who().id;
  first.station = store.environment().station;
  first.action = "add";
  auto written = write(store, std::move(first));
  if (!written) {
    return written;
  }
  const auto done = change->commit();
  return done ? std::move(written) : tl::unexpected(done.error());
}

Expected<Revision> addRevision(Store& store,
                               RecordKind kind,
                               std::string_view record,
                               RevisionEdit edit) {
  auto change = StoreChange::begin(store, Permission::Read);
  if (!change) {
    return tl::unexpected(change.error());
  }
  auto revision = currentRevision(store, kind, record);
  if (!revision) {
    return revision;
  }
  if (revision->revision != edit.base_revision) {
    return stale(store, *revision, edit.base_revision);
  }
  if (revision->trashed && edit.trashed != false) {
    return fail(ErrorCode::StepNotAllowed, "it lies in the trash; take it out first");
  }
  revision->revision += 1;
  revision->at_ms = store.environment().now_ms();
  revision->author = change->who().id;
  revision->station = store.environment().station;
  revision->action = std::move(edit.action);
  revision->reason = std::move(edit.reason);
  revision->content = edit.content ? std::move(*edit.content) : std::move(revision->content);
  revision->parent = edit.parent.value_or(revision->parent);
  revision->state = edit.state.value_or(revision->state);
  revision->trashed = edit.trashed.value_or(revision->trashed);
  auto written = write(store, std::move(*revision));
  if (!written) {
    return written;
  }
  const auto done = change->commit();
  return done ? std::move(written) : tl::unexpected(done.error());
}

Expected<Revision> currentRevision(Store& store, RecordKind kind, std::string_view record) {
  auto found = readCurrent(store,
                           std::string("SELECT ") + kColumns + "FROM records r " + kJoin +
                               "WHERE r.id = ? AND r.kind = ? AND r.state <> 'erased'",
                           {std::string(record), std::string(nameOf(kind))});
  if (!found) {
    return tl::unexpected(found.error());
  }
  if (found->empty()) {
    return fail(ErrorCode::RecordMissing, std::string(nameOf(kind)) + " " + std::string(record));
  }
  return std::move(found->front());
}

Expected<std::vector<Revision>> allRevisions(Store& store,
                                             RecordKind kind,
                                             std::string_view record) {
  const auto rows =
      store.database().query(std::string("SELECT ") + kColumns +
                                 "FROM records r JOIN revisions v ON v.record = r.id WHERE r.id = "
                                 "? AND r.kind = ? AND r.state <> 'erased' ORDER BY v.revision",
                             {std::string(record), std::string(nameOf(kind))});
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  if (rows->empty()) {
    return fail(ErrorCode::RecordMissing, std::string(nameOf(kind)) + " " + std::string(record));
  }
  std::vector<Revision> revisions;
  for (const SqlRow& row : *rows) {
    auto revision = opened(store, clearPart(row), row.bytes(11));
    if (!revision) {
      return tl::unexpected(revision.error());
    }
    if (revision->revision != static_cast<std::int64_t>(revisions.size()) + 1) {
      return damaged(revision->record, "a revision is missing");
    }
    revisions.push_back(std::move(*revision));
  }
  return revisions;
}

Expected<std::vector<Revision>> currentTree(Store& store, std::string_view root) {
  return readCurrent(
      store,
      // UNION, not UNION ALL: a ring made by a damaged table ends.
      std::string("WITH RECURSIVE tree (id) AS (SELECT id FROM records WHERE id = ? UNION SELECT "
                  "c.id FROM records c JOIN tree t ON c.parent = t.id) SELECT ") +
          kColumns + "FROM tree t JOIN records r ON r.id = t.id " + kJoin +
          "WHERE r.state <> 'erased' ORDER BY r.id",
      {std::string(root)});
}

Expected<std::vector<Revision>> currentOfKind(Store& store,
                                              RecordKind kind,
                                              std::int64_t after_entry) {
  return readCurrent(store,
                     std::string("SELECT ") + kColumns + "FROM records r " + kJoin +
                         "WHERE r.kind = ? AND r.entry > ? AND r.state <> 'erased' ORDER BY "
                         "r.entry",
                     {std::string(nameOf(kind)), after_entry});
}

Expected<std::vector<Revision>> currentInState(Store& store,
                                               RecordKind kind,
                                               std::string_view state) {
  return readCurrent(store,
                     std::string("SELECT ") + kColumns + "FROM records r " + kJoin +
                         "WHERE r.kind = ? AND r.state = ? ORDER BY r.entry",
                     {std::string(nameOf(kind)), std::string(state)});
}

Expected<void> requireUsable(Store& store, RecordKind kind, std::string_view record) {
  const auto revision = currentRevision(store, kind, record);
  if (!revision) {
    return tl::unexpected(revision.error());
  }
  if (revision->trashed) {
    return fail(ErrorCode::StepNotAllowed,
                std::string(nameOf(kind)) + " " + revision->record +
                    " lies in the trash; take it out first");
  }
  return {};
}

Expected<Bytes> revisionDigest(Vault& vault, const Revision& revision, const Bytes& sealed) {
  const auto key = vault.key(KeyPurpose::Audit);
  if (!key) {
    return tl::unexpected(key.error());
  }
  return keyedHash(**key, "revision " + identityOf(revision) + hexOf(sealed));
}

std::string timeText(std::int64_t at_ms) {
  const std::chrono::sys_time<std::chrono::milliseconds> at{std::chrono::milliseconds(at_ms)};
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(std::chrono::floor<std::chrono::seconds>(at - day));
  std::array<char, 64> text{};
  std::snprintf(text.data(),
                text.size(),
                "%04d-%02u-%02u %02d:%02d:%02d UTC",
                static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()),
                static_cast<int>(time.hours().count()),
                static_cast<int>(time.minutes().count()),
                static_cast<int>(time.seconds().count()));
  return text.data();
}

}  // namespace tarsus
