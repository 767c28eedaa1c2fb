#include "measurement/records/history.h"

#include "measurement/records/revisions.h"
#include "measurement/records/subjects.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>

namespace tarsus {
namespace {

template <typename Record>
Expected<void> put(std::vector<Record>& list, Expected<Record> record) {
  if (!record) {
    return tl::unexpected(record.error());
  }
  list.push_back(std::move(*record));
  return {};
}

Expected<void> putInPlace(PatientHistory& history, const Revision& revision) {
  switch (revision.kind) {
    case RecordKind::Patient:
      return put(history.merged, readPatient(revision));
    case RecordKind::Foot:
      return put(history.feet, readFoot(revision));
    case RecordKind::Wound:
      return put(history.wounds, readWound(revision));
    case RecordKind::Visit:
      return put(history.visits, readVisit(revision));
    case RecordKind::Measurement:
      return put(history.measurements, readMeasurement(revision));
    case RecordKind::User:
    case RecordKind::Settings:
      break;
  }
  return {};
}

/// What lies below a record in the trash is in the trash with it.
bool isTrashed(const std::unordered_map<std::string, const Revision*>& tree,
               const Revision& revision) {
  const Revision* at = &revision;
  for (std::size_t depth = 0; depth < tree.size(); ++depth) {
    if (at->trashed) {
      return true;
    }
    const auto parent = tree.find(at->parent);
    if (parent == tree.end()) {
      return false;
    }
    at = parent->second;
  }
  return false;
}

}  // namespace

Expected<std::string> patientOf(Store& store, const Visit& visit) {
  return findWound(store, visit.wound_id)
      .and_then([&](const Wound& wound) { return findFoot(store, wound.foot_id); })
      .and_then([&](const Foot& foot) { return findPatient(store, foot.patient_id); })
      .map([](const Patient& patient) {
        return patient.merged_into.empty() ? patient.id : patient.merged_into;
      });
}

Expected<PatientHistory> patientHistory(Store& store, std::string_view patient_id) {
  auto patient = findPatient(store, patient_id);
  if (!patient) {
    return tl::unexpected(patient.error());
  }
  const auto revisions = currentTree(store, patient_id);
  if (!revisions) {
    return tl::unexpected(revisions.error());
  }
  PatientHistory history{.patient = std::move(*patient)};
  std::unordered_map<std::string, const Revision*> tree;
  for (const Revision& revision : *revisions) {
    if (revision.record != patient_id) {  // a patient in the trash can still be looked at
      tree.emplace(revision.record, &revision);
    }
  }
  for (const Revision& revision : *revisions) {
    if (revision.record == patient_id || isTrashed(tree, revision)) {
      continue;
    }
    if (auto placed = putInPlace(history, revision); !placed) {
      return tl::unexpected(placed.error());
    }
  }
  std::ranges::sort(
      history.wounds, {}, [](const Wound& wound) { return std::tie(wound.foot_id, wound.number); });
  std::ranges::sort(history.visits, {}, [](const Visit& visit) {
    return std::tie(visit.content.taken_at_ms, visit.id);
  });
  std::ranges::sort(history.measurements, {}, [](const Measurement& measurement) {
    return std::tie(measurement.at_ms, measurement.id);
  });
  return history;
}

}  // namespace tarsus
