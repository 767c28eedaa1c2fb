#pragma once

#include "measurement/records/revisions.h"
#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// Puts a patient, foot, wound or visit into the trash, with all below it; nothing is deleted.
/// @errors RecordStale, RecordInvalid (no reason for a visit that was signed), StepNotAllowed
/// (in the trash already), NotPermitted
[[nodiscard]] Expected<Revision> moveToTrash(Store& store,
                                             RecordKind kind,
                                             std::string_view id,
                                             std::int64_t base_revision,
                                             std::string_view reason = {});
/// @errors RecordStale, StepNotAllowed (not in the trash), NotPermitted
[[nodiscard]] Expected<Revision> takeFromTrash(Store& store,
                                               RecordKind kind,
                                               std::string_view id,
                                               std::int64_t base_revision);
[[nodiscard]] Expected<std::vector<Revision>> trash(Store& store);

struct Erasure {
  std::size_t records = 0;
  std::size_t files = 0;
  Warnings warnings;  ///< files that could not be removed, to be removed by hand
};

/// Lawful erasure of a patient and all below, also of records merged into it: every version's
/// content and the files that nobody else uses. What stays is a tombstone for each record in the
/// audit trail (who, when, where, the reason, given without naming the patient). Backups made
/// before keep their copy.
/// @errors NotPermitted, RecordInvalid (no reason), RecordMissing
[[nodiscard]] Expected<Erasure> erasePatient(Store& store,
                                             std::string_view id,
                                             std::string_view reason);

}  // namespace tarsus
