#include "measurement/records/check.h"

#include "measurement/records/content.h"
#include "measurement/records/revisions.h"

namespace tarsus {
namespace {

/// Each revision with the audit entry of the same number; whichever is missing reads as empty.
constexpr const char* kRevisions =
    "SELECT v.record, r.kind, v.revision, v.entry, v.parent, v.state, v.trashed, v.at_ms, "
    "v.author, v.station, v.action, v.sealed, a.subject, a.revision, a.digest, r.state "
    "FROM revisions v JOIN records r ON r.id = v.record LEFT JOIN audit a ON a.entry = v.entry "
    "WHERE v.entry > ? ORDER BY v.entry LIMIT ?";

Expected<bool> isErased(Store& store, const std::string& record) {
  const auto rows = store.database().query(
      "SELECT entry FROM audit WHERE subject = ? AND action = 'erase'", {record});
  return rows ? Expected<bool>(!rows->empty()) : tl::unexpected(rows.error());
}

Expected<bool> isAsAudited(Store& store, const SqlRow& row) {
  const Bytes sealed = row.bytes(11);
  if (row.text(12) != row.text(0) || row.integer(13) != row.integer(2)) {
    return false;
  }
  if (sealed.empty()) {
    return isErased(store, row.text(0));
  }
  return revisionDigest(store.vault(), clearPart(row), sealed).map([&](const Bytes& digest) {
    return digest == row.bytes(14);
  });
}

Expected<void> checkRevisions(Store& store, StoreCheck& check) {
  constexpr std::int64_t kAtOnce = 10000;
  std::int64_t seen = 0;
  for (bool more = true; more;) {
    const auto rows = store.database().query(kRevisions, {seen, kAtOnce});
    if (!rows) {
      return tl::unexpected(rows.error());
    }
    more = !rows->empty();
    for (const SqlRow& row : *rows) {
      const auto same = isAsAudited(store, row);
      if (!same) {
        return tl::unexpected(same.error());
      }
      if (!*same) {
        check.findings.push_back("record " + row.text(0) + ": revision " +
                                 std::to_string(row.integer(2)) + " is not as it was written");
      }
      seen = row.integer(3);
      ++check.revisions;
    }
  }
  return {};
}

/// Revisions that the audit trail remembers and the tables do not.
Expected<void> checkMissing(Store& store, StoreCheck& check) {
  const auto rows = store.database().query(
      "SELECT a.subject, a.revision FROM audit a LEFT JOIN revisions v ON v.entry = a.entry WHERE "
      "a.revision > 0 AND v.record IS NULL ORDER BY a.entry");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  for (const SqlRow& row : *rows) {
    check.findings.push_back("record " + row.text(0) + ": revision " +
                             std::to_string(row.integer(1)) + " is missing");
  }
  return {};
}

Expected<void> checkHeads(Store& store, StoreCheck& check) {
  const auto rows = store.database().query(
      "SELECT r.id FROM records r LEFT JOIN revisions v ON v.record = r.id AND v.revision = "
      "r.revision WHERE v.record IS NULL OR r.revision <> (SELECT MAX(m.revision) FROM revisions m "
      "WHERE m.record = r.id) OR (r.state <> 'erased' AND (v.entry <> r.entry OR v.parent <> "
      "r.parent OR v.state <> r.state OR v.trashed <> r.trashed)) ORDER BY r.id");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  for (const SqlRow& row : *rows) {
    check.findings.push_back("record " + row.text(0) +
                             ": its place in the table is not that of its last revision");
  }
  const auto hidden = store.database().query("SELECT id FROM records WHERE state = 'erased'");
  if (!hidden) {
    return tl::unexpected(hidden.error());
  }
  for (const SqlRow& row : *hidden) {
    const auto erased = isErased(store, row.text(0));
    if (!erased) {
      return tl::unexpected(erased.error());
    }
    if (!*erased) {
      check.findings.push_back("record " + row.text(0) + ": it is marked as erased and was not");
    }
  }
  return {};
}

Expected<void> checkFiles(Store& store, StoreCheck& check) {
  const auto rows = store.database().query("SELECT DISTINCT file FROM file_use ORDER BY file");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  for (const SqlRow& row : *rows) {
    ++check.files;
    if (const auto whole = store.files().verify(store.vault(), row.text(0)); !whole) {
      if (whole.error().code == ErrorCode::StoreLocked) {
        return whole;
      }
      check.findings.push_back(whole.error().detail);
    }
  }
  return {};
}

}  // namespace

Expected<StoreCheck> checkStore(Store& store) {
  if (auto who = store.who(Permission::VerifyAudit); !who) {
    return tl::unexpected(who.error());
  }
  auto audit = verifyAudit(store.database(), store.vault(), store.anchorFile());
  if (!audit) {
    return tl::unexpected(audit.error());
  }
  StoreCheck check{.audit = std::move(*audit)};
  if (!check.audit.finding.empty()) {
    check.findings.push_back("audit trail: " + check.audit.finding);
  }
  const auto done = checkRevisions(store, check)
                        .and_then([&] { return checkMissing(store, check); })
                        .and_then([&] { return checkHeads(store, check); })
                        .and_then([&] { return checkFiles(store, check); });
  return done ? Expected<StoreCheck>(std::move(check)) : tl::unexpected(done.error());
}

Expected<void> acceptAuditTrail(Store& store, std::string_view reason) {
  if (isBlank(reason)) {
    return fail(ErrorCode::RecordInvalid, "to accept the audit trail needs a reason");
  }
  auto change = StoreChange::begin(store, Permission::ManageUsers);
  if (!change) {
    return tl::unexpected(change.error());
  }
  const auto verdict = verifyAudit(store.database(), store.vault(), store.anchorFile());
  if (!verdict) {
    return tl::unexpected(verdict.error());
  }
  const auto done = noteAct(store,
                            Permission::ManageUsers,
                            "accept the trail",
                            std::string(reason) + " (found: " + verdict->finding + ")")
                        .and_then([&] { return change->commit(); });
  return done ? writeAuditAnchor(store.database(), store.anchorFile(), AnchorStep::Begin) : done;
}

}  // namespace tarsus
