#pragma once

#include "measurement/records/history.h"

#include <optional>
#include <string_view>
#include <vector>

namespace tarsus {

/// What is exported, as plain data; a writer of any format needs nothing else but the files.
struct ExportBundle {
  std::vector<PatientHistory> patients;
  bool pseudonymised = false;
};

/// The measurement that counts: the last one.
[[nodiscard]] const Measurement* measurementOf(const PatientHistory& history,
                                               std::string_view visit_id);

/// The history of one visit alone, with what it stands under.
/// @errors RecordMissing
[[nodiscard]] Expected<PatientHistory> historyOfVisit(Store& store, std::string_view visit_id);

/// @errors those of patientHistory
[[nodiscard]] Expected<std::vector<PatientHistory>> allHistories(Store& store);

}  // namespace tarsus
