#pragma once

#include "measurement/records/feet.h"
#include "measurement/records/patients.h"
#include "measurement/records/visits.h"
#include "measurement/records/wounds.h"

namespace tarsus {

/// All that is recorded of one patient, also under the records merged into this one, as it stands
/// now and without what lies in the trash.
struct PatientHistory {
  Patient patient;
  std::vector<Patient> merged;  ///< duplicates that were merged into the patient
  std::vector<Foot> feet;
  std::vector<Wound> wounds;              ///< by foot and number
  std::vector<Visit> visits;              ///< by the time they took place
  std::vector<Measurement> measurements;  ///< oldest first
};

/// The patient under whom a visit is read: the kept one where two were merged.
/// @errors RecordMissing, StoreLocked, StoreDamaged
[[nodiscard]] Expected<std::string> patientOf(Store& store, const Visit& visit);

/// @errors RecordMissing, StoreLocked, StoreDamaged
[[nodiscard]] Expected<PatientHistory> patientHistory(Store& store, std::string_view patient_id);

}  // namespace tarsus
