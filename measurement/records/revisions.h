#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What all records have in common: each is a chain of revisions, of which the last one counts.

namespace tarsus {

enum class RecordKind { Patient, Foot, Wound, Visit, Measurement, User, Settings };
[[nodiscard]] std::string_view nameOf(RecordKind kind);
[[nodiscard]] std::optional<RecordKind> recordKindNamed(std::string_view name);

/// A version of a record with what stands beside it in clear. All of it is bound to the sealed
/// content: none can be changed, or put into another row, without being found.
struct Revision {
  std::string record;
  RecordKind kind = RecordKind::Patient;
  std::int64_t revision = 0;  ///< 1, 2, 3, ...
  std::int64_t entry = 0;     ///< of the audit trail
  std::string parent;  ///< wound of a visit, foot of a wound, patient of a foot; of a patient: the
                       ///< one that it was merged into, or empty
  std::string state;
  bool trashed = false;
  std::int64_t at_ms = 0;
  std::string author;
  std::string station;
  std::string action;
  std::string reason;
  nlohmann::json content;
};

/// What of a row stands in clear: record, kind, revision, entry, parent, state, trashed, at_ms,
/// author, station, action, in this order.
[[nodiscard]] Revision clearPart(const SqlRow& row);

/// What one edit changes; what is not given stays as it was.
struct RevisionEdit {
  std::string action;
  std::int64_t base_revision = 0;  ///< that the edit was made on
  std::string reason;
  std::optional<nlohmann::json> content;
  std::optional<std::string> parent;
  std::optional<std::string> state;
  std::optional<bool> trashed;
};

/// The first revision. The caller has checked the role.
[[nodiscard]] Expected<Revision> addRecord(Store& store, Revision first);
/// @errors RecordStale (naming who changed it and when), RecordMissing, StepNotAllowed (in the
/// trash)
[[nodiscard]] Expected<Revision> addRevision(Store& store,
                                             RecordKind kind,
                                             std::string_view record,
                                             RevisionEdit edit);

/// @errors RecordMissing (never there, of another kind, or erased), StoreDamaged
[[nodiscard]] Expected<Revision> currentRevision(Store& store,
                                                 RecordKind kind,
                                                 std::string_view record);
/// All versions, oldest first. @errors RecordMissing, StoreDamaged
[[nodiscard]] Expected<std::vector<Revision>> allRevisions(Store& store,
                                                           RecordKind kind,
                                                           std::string_view record);
/// The record and everything below it as it stands now, without erased records.
[[nodiscard]] Expected<std::vector<Revision>> currentTree(Store& store, std::string_view root);
/// All records of a kind that were changed after an audit entry, without erased ones.
[[nodiscard]] Expected<std::vector<Revision>> currentOfKind(Store& store,
                                                            RecordKind kind,
                                                            std::int64_t after_entry = 0);
[[nodiscard]] Expected<std::vector<Revision>> currentInState(Store& store,
                                                             RecordKind kind,
                                                             std::string_view state);
/// Whether a record of this kind is there and neither erased nor in the trash.
/// @errors RecordMissing, StepNotAllowed
[[nodiscard]] Expected<void> requireUsable(Store& store, RecordKind kind, std::string_view record);

/// Keyed hash over a revision's row; the audit trail keeps it.
[[nodiscard]] Expected<Bytes> revisionDigest(Vault& vault,
                                             const Revision& revision,
                                             const Bytes& sealed);

/// State of a record whose content was erased.
inline constexpr std::string_view kErased = "erased";
/// 2026-03-01 14:05:09 UTC
[[nodiscard]] std::string timeText(std::int64_t at_ms);

}  // namespace tarsus
