#include "measurement/records/export/bundle.h"

#include <algorithm>

namespace tarsus {
namespace {

template <typename Records, typename Keep>
void keepOnly(Records& records, Keep keep) {
  std::erase_if(records, [&](const auto& record) { return !keep(record); });
}

}  // namespace

const Measurement* measurementOf(const PatientHistory& history, std::string_view visit_id) {
  const Measurement* last = nullptr;
  for (const Measurement& measurement : history.measurements) {
    last = measurement.visit_id == visit_id ? &measurement : last;
  }
  return last;
}

Expected<PatientHistory> historyOfVisit(Store& store, std::string_view visit_id) {
  const auto visit = findVisit(store, visit_id);
  if (!visit) {
    return tl::unexpected(visit.error());
  }
  const auto wound = findWound(store, visit->wound_id);
  const auto patient = patientOf(store, *visit);
  if (!wound || !patient) {
    return tl::unexpected(!wound ? wound.error() : patient.error());
  }
  auto history = patientHistory(store, *patient);
  if (!history) {
    return history;
  }
  keepOnly(history->feet, [&](const Foot& f) { return f.id == wound->foot_id; });
  keepOnly(history->wounds, [&](const Wound& w) { return w.id == wound->id; });
  keepOnly(history->visits, [&](const Visit& v) { return v.id == visit_id; });
  keepOnly(history->measurements, [&](const Measurement& m) { return m.visit_id == visit_id; });
  if (history->visits.empty()) {
    return fail(ErrorCode::RecordMissing,
                "visit " + std::string(visit_id) + " lies in the trash; take it out first");
  }
  return history;
}

Expected<std::vector<PatientHistory>> allHistories(Store& store) {
  const auto patients = allPatients(store);
  if (!patients) {
    return tl::unexpected(patients.error());
  }
  std::vector<PatientHistory> all;
  for (const Patient& patient : *patients) {
    auto history = patientHistory(store, patient.id);
    if (!history) {
      return tl::unexpected(history.error());
    }
    all.push_back(std::move(*history));
  }
  std::ranges::sort(all, {}, [](const PatientHistory& h) { return h.patient.id; });
  return all;
}

}  // namespace tarsus
