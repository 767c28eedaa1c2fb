#pragma once

#include "measurement/records/feet.h"
#include "measurement/records/patients.h"
#include "measurement/records/revisions.h"
#include "measurement/records/visits.h"
#include "measurement/records/wounds.h"

// What the subjects' .cpp files share.

namespace tarsus {

[[nodiscard]] Expected<Patient> readPatient(const Revision& revision);
[[nodiscard]] Expected<Foot> readFoot(const Revision& revision);
[[nodiscard]] Expected<Wound> readWound(const Revision& revision);
[[nodiscard]] Expected<Visit> readVisit(const Revision& revision);
[[nodiscard]] Expected<Measurement> readMeasurement(const Revision& revision);

/// Runs `work(who)` as one change of the records: all of it or nothing.
template <typename Result, typename Work>
[[nodiscard]] Expected<Result> inChange(Store& store, Permission permission, const Work& work) {
  auto change = StoreChange::begin(store, permission);
  if (!change) {
    return tl::unexpected(change.error());
  }
  Expected<Result> result = work(change->who());
  if (!result) {
    return result;
  }
  const auto done = change->commit();
  return done ? std::move(result) : tl::unexpected(done.error());
}

}  // namespace tarsus
