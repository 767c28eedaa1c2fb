#pragma once

#include "measurement/records/audit.h"
#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

struct StoreCheck {
  AuditVerdict audit;
  std::vector<std::string> findings;  ///< one sentence each; none: all is as it was written
  std::size_t revisions = 0;
  std::size_t files = 0;
};

/// The whole store: the audit chain, each revision against the audit entry made with it, where each
/// record stands against its last revision, and each file that a record uses against its name.
/// Finds what was changed, removed or put in outside this program; what was erased lawfully has
/// its tombstone and is no finding.
[[nodiscard]] Expected<StoreCheck> checkStore(Store& store);

/// After a finding about the trail's end was looked into, as when tables were restored by hand:
/// goes on from the trail as it is. Finding and reason become an entry of it. Administrators only.
/// @errors NotPermitted, RecordInvalid (no reason)
[[nodiscard]] Expected<void> acceptAuditTrail(Store& store, std::string_view reason);

}  // namespace tarsus
