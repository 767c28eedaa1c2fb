#pragma once

#include "measurement/records/store.h"
#include "ui/work/patient_summary.h"

#include <QDate>
#include <QString>

#include <string>
#include <vector>

namespace tarsus {

/// A patient as the list knows it before anything is decrypted.
struct PatientKey {
  std::string id;
  std::int64_t last_at_ms = 0;  ///< when one of the visits was last written
  bool has_draft = false;
};

/// Patients in the order of the list: last worked on first; those in the trash or merged into
/// another are left out.
/// @errors StoreLocked, those of Database
[[nodiscard]] Expected<std::vector<PatientKey>> patientKeys(Store& store);

/// Ids that a search finds (name_index.h), sorted.
[[nodiscard]] Expected<std::vector<std::string>> matchingPatients(Store& store,
                                                                  const std::string& query);

/// One row of the list; of several wounds the one last seen.
struct PatientRow {
  QString id;
  QString name;
  QString born_and_number;
  QString site;  ///< in words, empty: no wound
  FootSide side = FootSide::Right;
  QString place;
  bool healed = false;
  QDate last_visit;
  std::optional<double> area_mm2;
  std::vector<double> areas_mm2;
  std::optional<VisitState> state;
  QString spoken;
};
[[nodiscard]] Expected<PatientRow> patientRow(Store& store, const std::string& id);

/// A signed visit that waits for a physician.
struct ReviewItem {
  QString visit_id;
  QString patient_id;
  QString patient;
  QString site;
  QString taken;  ///< "16 Nov, S. Lindqvist"
  std::optional<double> area_mm2;
  QString change;  ///< "18 % smaller", empty at the first visit
};
/// Oldest first.
[[nodiscard]] Expected<std::vector<ReviewItem>> reviewItems(Store& store);

}  // namespace tarsus
