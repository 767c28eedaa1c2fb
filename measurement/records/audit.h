#pragma once

#include "measurement/records/database.h"
#include "measurement/records/vault.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tarsus {

/// Who did what, when, where, to which record. `details` are sealed; the rest stands in clear.
struct AuditEntry {
  std::int64_t entry = 0;  ///< 1, 2, 3, ... without gaps
  std::int64_t at_ms = 0;
  std::string who;  ///< the user's record
  std::string station;
  std::string action;
  std::string subject;        ///< the record's id; empty: the store itself
  std::int64_t revision = 0;  ///< that was written; 0: none
  Bytes digest;               ///< of that revision (revisions.h)
  std::string details;
};

/// Appends one entry to the chain; its hash covers the one before. Inside a transaction.
/// @return the entry's number
[[nodiscard]] Expected<std::int64_t> appendAudit(Database& database,
                                                 Vault& vault,
                                                 AuditEntry entry);

/// Entry numbers first to last, details opened.
[[nodiscard]] Expected<std::vector<AuditEntry>> auditEntries(Database& database,
                                                             Vault& vault,
                                                             std::int64_t first,
                                                             std::int64_t last);

/// Follow: the place must stand on this very chain; one that does not, or is gone, is evidence and
/// stays as it is, for verifyAudit to tell. Begin: whatever was there is written over.
enum class AnchorStep { Begin, Follow };
/// Keeps the head of the chain in a second place, so that a trail cut off at its end, or put back
/// to an older one, is found. An older head is never written over a newer one.
/// @errors FileMissing, StoreDamaged (Follow), FileUnwritable
[[nodiscard]] Expected<void> writeAuditAnchor(Database& database,
                                              const std::filesystem::path& file,
                                              AnchorStep step = AnchorStep::Follow);

struct AuditVerdict {
  std::int64_t entries = 0;
  std::optional<std::int64_t> broken_at;  ///< the first entry that is missing or not as written
  std::string finding;                    ///< what is wrong, or empty
  std::int64_t not_anchored = 0;  ///< entries at the end that the second place does not cover
};

/// Walks the whole chain. Finds an entry changed, removed, put in or out of order by anybody who
/// has not the store key, and a tail cut off unless the anchor was put back to an older one too.
[[nodiscard]] Expected<AuditVerdict> verifyAudit(Database& database,
                                                 Vault& vault,
                                                 const std::filesystem::path& anchor);

}  // namespace tarsus
