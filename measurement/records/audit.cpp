#include "measurement/records/audit.h"

#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr const char* kColumns =
    "SELECT entry, at_ms, who, station, action, subject, revision, digest, details, hash "
    "FROM audit ";

std::string detailsIdentity(std::int64_t entry) { return "audit " + std::to_string(entry); }

struct Row {
  AuditEntry entry;  ///< details still sealed
  Bytes sealed_details;
  Bytes hash;
};

Row rowOf(const SqlRow& row) {
  return {.entry = {.entry = row.integer(0),
                    .at_ms = row.integer(1),
                    .who = row.text(2),
                    .station = row.text(3),
                    .action = row.text(4),
                    .subject = row.text(5),
                    .revision = row.integer(6),
                    .digest = row.bytes(7)},
          .sealed_details = row.bytes(8),
          .hash = row.bytes(9)};
}

/// A JSON list, so that no two different entries give the same bytes.
Bytes hashOf(const SecretKey& key, const Bytes& previous, const Row& row) {
  const AuditEntry& entry = row.entry;
  const json fields = {hexOf(previous),
                       entry.entry,
                       entry.at_ms,
                       entry.who,
                       entry.station,
                       entry.action,
                       entry.subject,
                       entry.revision,
                       hexOf(entry.digest),
                       hexOf(row.sealed_details)};
  return keyedHash(key, fields.dump(-1, ' ', false, json::error_handler_t::replace));
}

struct Head {
  std::int64_t entry = 0;
  Bytes hash;
};

Expected<Head> headOf(Database& database) {
  const auto rows = database.query("SELECT entry, hash FROM audit ORDER BY entry DESC LIMIT 1");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  return rows->empty() ? Head{}
                       : Head{.entry = rows->front().integer(0), .hash = rows->front().bytes(1)};
}

struct Anchor {
  std::int64_t entries = 0;
  std::string hash;
};

Expected<Anchor> readAnchor(const std::filesystem::path& file) {
  const auto text = readTextFile(file);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const json object = json::parse(*text, nullptr, false);
  if (!object.is_object() || !object.contains("entries") || !object.contains("hash") ||
      !object["entries"].is_number_integer() || !object["hash"].is_string()) {
    return fail(ErrorCode::StoreDamaged, file.string());
  }
  return Anchor{.entries = object["entries"].get<std::int64_t>(),
                .hash = object["hash"].get<std::string>()};
}

AuditVerdict broken(std::int64_t entries, std::int64_t at, std::string finding) {
  return {.entries = entries, .broken_at = at, .finding = std::move(finding)};
}

/// What the second place says about a chain that is whole in itself.
AuditVerdict compareAnchor(const Expected<Anchor>& anchor,
                           std::int64_t entries,
                           const std::string& hash_at_anchor) {
  if (!anchor) {
    return {.entries = entries,
            .finding =
                "the second place of the audit trail's head cannot be read, so that a "
                "missing end would not be seen: " +
                anchor.error().detail,
            .not_anchored = entries};
  }
  if (anchor->entries > entries) {
    return broken(entries,
                  entries + 1,
                  "the end is missing: " + std::to_string(anchor->entries) +
                      " entries were written, " + std::to_string(entries) + " are there");
  }
  if (anchor->hash != hash_at_anchor) {
    return broken(entries,
                  anchor->entries,
                  "entry " + std::to_string(anchor->entries) +
                      " is not the one that the second place remembers");
  }
  return {.entries = entries, .not_anchored = entries - anchor->entries};
}

}  // namespace

Expected<std::int64_t> appendAudit(Database& database, Vault& vault, AuditEntry entry) {
  const auto audit_key = vault.key(KeyPurpose::Audit);
  const auto field_key = vault.key(KeyPurpose::Fields);
  if (!audit_key || !field_key) {
    return fail(ErrorCode::StoreLocked);
  }
  const auto head = headOf(database);
  if (!head) {
    return tl::unexpected(head.error());
  }
  entry.entry = head->entry + 1;
  Row row{.entry = entry,
          .sealed_details = seal(**field_key, entry.details, detailsIdentity(entry.entry))};
  row.hash = hashOf(**audit_key, head->hash, row);
  const auto written = database.execute(
      "INSERT INTO audit (entry, at_ms, who, station, action, subject, revision, digest, details, "
      "hash) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {entry.entry,
       entry.at_ms,
       entry.who,
       entry.station,
       entry.action,
       entry.subject,
       entry.revision,
       entry.digest,
       row.sealed_details,
       row.hash});
  if (!written) {
    return written;
  }
  return entry.entry;
}

Expected<std::vector<AuditEntry>> auditEntries(Database& database,
                                               Vault& vault,
                                               std::int64_t first,
                                               std::int64_t last) {
  const auto key = vault.key(KeyPurpose::Fields);
  if (!key) {
    return tl::unexpected(key.error());
  }
  const auto rows = database.query(
      std::string(kColumns) + "WHERE entry >= ? AND entry <= ? ORDER BY entry", {first, last});
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  std::vector<AuditEntry> entries;
  for (const SqlRow& sql_row : *rows) {
    Row row = rowOf(sql_row);
    auto details = openSealed(**key, row.sealed_details, detailsIdentity(row.entry.entry));
    if (!details) {
      return fail(ErrorCode::StoreDamaged, "audit entry " + std::to_string(row.entry.entry));
    }
    row.entry.details = std::move(*details);
    entries.push_back(std::move(row.entry));
  }
  return entries;
}

Expected<void> writeAuditAnchor(Database& database,
                                const std::filesystem::path& file,
                                AnchorStep step) {
  const auto head = headOf(database);
  if (!head) {
    return tl::unexpected(head.error());
  }
  if (step == AnchorStep::Follow) {
    const auto anchor = readAnchor(file);
    if (!anchor) {
      return tl::unexpected(anchor.error());
    }
    if (anchor->entries >= head->entry) {
      return {};
    }
    const auto at = database.query("SELECT hash FROM audit WHERE entry = ?", {anchor->entries});
    if (!at) {
      return tl::unexpected(at.error());
    }
    if (at->empty() || hexOf(at->front().bytes(0)) != anchor->hash) {
      return fail(ErrorCode::StoreDamaged, file.string() + " belongs to another audit trail");
    }
  }
  const json object = {{"entries", head->entry}, {"hash", hexOf(head->hash)}};
  return writeTextAtomically(file, object.dump() + "\n");
}

Expected<AuditVerdict> verifyAudit(Database& database,
                                   Vault& vault,
                                   const std::filesystem::path& anchor_file) {
  constexpr std::int64_t kAtOnce = 10000;  // a large trail does not fit into memory
  const auto anchor = readAnchor(anchor_file);
  std::string hash_at_anchor;
  Bytes previous;
  std::int64_t entries = 0;
  for (bool more = true; more;) {
    const auto key = vault.key(KeyPurpose::Audit);
    if (!key) {
      return tl::unexpected(key.error());
    }
    const auto rows = database.query(
        std::string(kColumns) + "WHERE entry > ? ORDER BY entry LIMIT ?", {entries, kAtOnce});
    if (!rows) {
      return tl::unexpected(rows.error());
    }
    more = !rows->empty();
    for (const SqlRow& sql_row : *rows) {
      const Row row = rowOf(sql_row);
      if (row.entry.entry != entries + 1) {
        return broken(entries, entries + 1, "entry " + std::to_string(entries + 1) + " is missing");
      }
      if (row.hash != hashOf(**key, previous, row)) {
        return broken(entries,
                      row.entry.entry,
                      "entry " + std::to_string(row.entry.entry) + " is not as it was written");
      }
      previous = row.hash;
      entries = row.entry.entry;
      if (anchor && anchor->entries == entries) {
        hash_at_anchor = hexOf(row.hash);
      }
    }
  }
  return compareAnchor(anchor, entries, hash_at_anchor);
}

}  // namespace tarsus
