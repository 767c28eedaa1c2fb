#pragma once

#include "measurement/comparison/healing_rates.h"
#include "measurement/records/history.h"

#include <QDate>
#include <QString>

#include <optional>
#include <vector>

namespace tarsus {

struct VisitSummary {
  std::string id;
  QDate date;
  VisitState state = VisitState::Draft;
  bool usable_scan = true;
  std::optional<double> area_mm2;
  std::optional<Interval> area_interval_mm2;  ///< 95 %
  std::optional<double> perimeter_mm;
  QString debridement;  ///< in words, empty where there was none
  std::string author;   ///< user
};

struct WoundSummary {
  std::string id;
  FootSide side = FootSide::Right;
  WoundFields fields;
  int number = 1;
  std::vector<VisitSummary> visits;  ///< oldest first

  [[nodiscard]] bool healed() const { return !fields.healed_on.empty(); }
};

/// A value of the form as it was last filled in.
struct LastKnown {
  QString name;
  QString value;
  QDate date;
};

/// What a patient's page and the list show, made from the history away from the window.
struct PatientSummary {
  Patient patient;
  std::vector<Foot> feet;
  std::vector<WoundSummary> wounds;  ///< right foot first
  std::vector<LastKnown> known;
};

[[nodiscard]] Expected<PatientSummary> patientSummary(Store& store, const std::string& id);

/// Area now over area then; none where either is missing or then is 0.
[[nodiscard]] std::optional<double> areaRatio(const VisitSummary& then, const VisitSummary& now);
/// How fast the edge moved inwards [mm per week] (Gilman); none where it cannot be known.
[[nodiscard]] std::optional<double> edgeAdvance(const VisitSummary& then, const VisitSummary& now);
/// "18 % smaller", "21 % larger", "within error" where the change is not detectable; empty where
/// one of the areas is missing.
[[nodiscard]] QString changeInWords(const VisitSummary& then, const VisitSummary& now);
/// "Holm, Margarete" as it is said: "Margarete Holm".
[[nodiscard]] QString fullName(const PatientFields& fields);
[[nodiscard]] QDate dateOf(const std::string& iso);
[[nodiscard]] QDate dateAt(std::int64_t at_ms);

}  // namespace tarsus
