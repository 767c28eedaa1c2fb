#include "measurement/records/removal.h"

#include "measurement/records/audit.h"
#include "measurement/records/content.h"
#include "measurement/records/subjects.h"

namespace tarsus {
namespace {

bool isClinical(RecordKind kind) {
  return kind == RecordKind::Patient || kind == RecordKind::Foot || kind == RecordKind::Wound ||
         kind == RecordKind::Visit;
}

Expected<void> eraseContent(Store& store,
                            const SignedIn& who,
                            const std::string& id,
                            std::string_view reason) {
  const auto entry = appendAudit(store.database(),
                                 store.vault(),
                                 {.at_ms = store.environment().now_ms(),
                                  .who = who.id,
                                  .station = store.environment().station,
                                  .action = "erase",
                                  .subject = id,
                                  .details = std::string(reason)});
  if (!entry) {
    return tl::unexpected(entry.error());
  }
  const auto emptied =
      store.database().execute("UPDATE revisions SET sealed = ? WHERE record = ?", {Bytes(), id});
  const auto marked = store.database().execute(
      "UPDATE records SET state = 'erased', entry = ? WHERE id = ?", {*entry, id});
  if (!emptied || !marked) {
    return tl::unexpected(!emptied ? emptied.error() : marked.error());
  }
  return {};
}

/// Ids of the tree without opening it, so that also a damaged record can be erased.
Expected<std::vector<std::string>> idsBelow(Store& store, std::string_view root) {
  const auto rows = store.database().query(
      "WITH RECURSIVE tree (id) AS (SELECT id FROM records WHERE id = ? AND kind = 'patient' AND "
      "state <> 'erased' UNION SELECT c.id FROM records c JOIN tree t ON c.parent = t.id) SELECT "
      "id FROM tree ORDER BY id",
      {std::string(root)});
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  std::vector<std::string> ids;
  for (const SqlRow& row : *rows) {
    ids.push_back(row.text(0));
  }
  if (ids.empty()) {
    return fail(ErrorCode::RecordMissing, "patient " + std::string(root));
  }
  return ids;
}

/// @return the files of the record that no other record uses any more
Expected<std::vector<std::string>> releaseFiles(Store& store, const std::string& id) {
  Database& database = store.database();
  const auto used = database.query("SELECT file FROM file_use WHERE record = ?", {id});
  const auto released = database.execute("DELETE FROM file_use WHERE record = ?", {id});
  if (!used || !released) {
    return tl::unexpected(!used ? used.error() : released.error());
  }
  std::vector<std::string> unused;
  for (const SqlRow& row : *used) {
    const auto others =
        database.query("SELECT record FROM file_use WHERE file = ? LIMIT 1", {row.text(0)});
    if (!others) {
      return tl::unexpected(others.error());
    }
    if (others->empty()) {
      unused.push_back(row.text(0));
    }
  }
  return unused;
}

struct Released {
  std::size_t records = 0;
  std::vector<std::string> files;
};

Expected<Released> eraseTree(Store& store,
                             const SignedIn& who,
                             std::string_view root,
                             std::string_view reason) {
  const auto ids = idsBelow(store, root);
  if (!ids) {
    return tl::unexpected(ids.error());
  }
  Released released{.records = ids->size()};
  for (const std::string& id : *ids) {
    auto erased = eraseContent(store, who, id, reason);
    auto files = erased.and_then([&] { return releaseFiles(store, id); });
    if (!files) {
      return tl::unexpected(files.error());
    }
    released.files.insert(released.files.end(), files->begin(), files->end());
  }
  return released;
}

/// What was overwritten may still lie in the log and in dead rows.
Expected<void> forgetOldPages(Database& database) {
  const bool sqlite = database.engine() == Database::Engine::Sqlite;
  const auto done = database.query(sqlite ? "PRAGMA wal_checkpoint(TRUNCATE)" : "VACUUM revisions");
  return done ? Expected<void>() : tl::unexpected(done.error());
}

}  // namespace

Expected<Revision> moveToTrash(Store& store,
                               RecordKind kind,
                               std::string_view id,
                               std::int64_t base_revision,
                               std::string_view reason) {
  if (!isClinical(kind)) {
    return fail(ErrorCode::StepNotAllowed, "only patients, feet, wounds and visits can be trashed");
  }
  return inChange<Revision>(store, Permission::Trash, [&](const SignedIn&) -> Expected<Revision> {
    const auto revision = currentRevision(store, kind, id);
    if (!revision) {
      return revision;
    }
    const bool is_signed =
        kind == RecordKind::Visit && revision->state != nameOf(VisitState::Draft);
    if (is_signed && isBlank(reason)) {
      return fail(ErrorCode::RecordInvalid, "to trash a signed visit needs a reason");
    }
    return addRevision(store,
                       kind,
                       id,
                       {.action = "trash",
                        .base_revision = base_revision,
                        .reason = std::string(reason),
                        .trashed = true});
  });
}

Expected<Revision> takeFromTrash(Store& store,
                                 RecordKind kind,
                                 std::string_view id,
                                 std::int64_t base_revision) {
  return inChange<Revision>(store, Permission::Trash, [&](const SignedIn&) -> Expected<Revision> {
    const auto revision = currentRevision(store, kind, id);
    if (!revision) {
      return revision;
    }
    if (!revision->trashed) {
      return fail(ErrorCode::StepNotAllowed, "it does not lie in the trash");
    }
    return addRevision(
        store,
        kind,
        id,
        {.action = "take from trash", .base_revision = base_revision, .trashed = false});
  });
}

Expected<std::vector<Revision>> trash(Store& store) {
  if (auto who = store.who(Permission::Read); !who) {
    return tl::unexpected(who.error());
  }
  const auto rows = store.database().query(
      "SELECT id, kind FROM records WHERE trashed = 1 AND state <> 'erased' ORDER BY entry");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  std::vector<Revision> revisions;
  for (const SqlRow& row : *rows) {
    const auto kind = recordKindNamed(row.text(1));
    auto revision = kind ? currentRevision(store, *kind, row.text(0))
                         : fail(ErrorCode::StoreDamaged, "record " + row.text(0));
    if (!revision) {
      return tl::unexpected(revision.error());
    }
    revisions.push_back(std::move(*revision));
  }
  return revisions;
}

Expected<Erasure> erasePatient(Store& store, std::string_view id, std::string_view reason) {
  if (isBlank(reason)) {
    return fail(ErrorCode::RecordInvalid, "an erasure needs a reason, without the patient's name");
  }
  const auto released = inChange<Released>(store, Permission::Erase, [&](const SignedIn& who) {
    return eraseTree(store, who, id, reason);
  });
  if (!released) {
    return tl::unexpected(released.error());
  }
  Erasure erasure{.records = released->records};
  for (const std::string& file : released->files) {
    if (auto removed = store.files().remove(file); removed) {
      ++erasure.files;
    } else {
      erasure.warnings.push_back({.code = "file_not_removed", .text = removed.error().detail});
    }
  }
  if (auto forgotten = forgetOldPages(store.database()); !forgotten) {
    erasure.warnings.push_back({.code = "old_pages_kept", .text = forgotten.error().detail});
  }
  return erasure;
}

}  // namespace tarsus
