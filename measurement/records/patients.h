#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

struct PatientFields {
  std::string family_name;
  std::string given_name;
  std::string birth_date;  ///< 1950-12-31, or empty where it is not known
  std::string identifier;  ///< of the clinic, or empty
};

struct Patient {
  std::string id;
  std::int64_t revision = 0;
  PatientFields fields;
  std::string merged_into;  ///< the patient that this one turned out to be; empty: none
  bool trashed = false;
};

/// @errors RecordInvalid (no name, no such date), NotPermitted
[[nodiscard]] Expected<Patient> addPatient(Store& store, const PatientFields& fields);
/// @errors RecordStale, RecordInvalid, NotPermitted
[[nodiscard]] Expected<Patient> editPatient(Store& store,
                                            std::string_view id,
                                            std::int64_t base_revision,
                                            const PatientFields& fields);
/// @errors RecordMissing
[[nodiscard]] Expected<Patient> findPatient(Store& store, std::string_view id);

/// All patients without those in the trash or merged into another, by name.
[[nodiscard]] Expected<std::vector<Patient>> allPatients(Store& store);

/// Patients of whom each word of the query begins a word of the name, the identifier or the birth
/// date, whatever the case and accents; without those in the trash or merged into another. The
/// first search after signing in reads all names.
[[nodiscard]] Expected<std::vector<Patient>> searchPatients(Store& store,
                                                            std::string_view query,
                                                            std::size_t most = 50);

/// The same person was entered twice: `duplicate` with all its feet is from now on read as part
/// of `kept`. Nothing is rewritten, so that it can be undone whatever was added meanwhile.
/// @errors RecordStale, StepNotAllowed (already merged, or into itself), RecordInvalid (no
/// reason), NotPermitted
[[nodiscard]] Expected<Patient> mergePatients(Store& store,
                                              std::string_view kept,
                                              std::string_view duplicate,
                                              std::int64_t duplicate_revision,
                                              std::string_view reason);
/// @errors RecordStale, StepNotAllowed (it is not merged), RecordInvalid (no reason)
[[nodiscard]] Expected<Patient> undoMerge(Store& store,
                                          std::string_view duplicate,
                                          std::int64_t base_revision,
                                          std::string_view reason);

}  // namespace tarsus
