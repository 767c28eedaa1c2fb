#pragma once

#include "measurement/records/history.h"

#include <QDate>

#include <map>
#include <string>
#include <vector>

namespace tarsus {

/// A field of the form as an earlier visit of the same wound has it.
struct EarlierValue {
  nlohmann::json value;
  QDate date;
};

/// All that the steps of a visit need to know of it, read away from the window.
struct VisitFacts {
  Visit visit;
  Patient patient;
  Foot foot;
  Wound wound;
  int week = 0;            ///< since the wound's first visit
  std::string last_visit;  ///< of the same wound, before this one; empty: this is the first
  std::map<std::string, EarlierValue> earlier;  ///< by field: the newest that has it
};

/// @errors RecordMissing, StoreLocked, StoreDamaged
[[nodiscard]] Expected<VisitFacts> visitFacts(Store& store, const std::string& visit_id);

/// A form as it was read or saved last, and as it stands now.
struct FormEdit {
  std::string visit_id;
  std::int64_t base_revision = 0;
  nlohmann::json before;
  nlohmann::json now;
  bool usable_scan = true;
};

struct FormSaved {
  Visit visit;
  bool merged = false;                ///< another station had written meanwhile
  std::vector<std::string> disputed;  ///< fields that both had changed: ours stands, theirs is kept
                                      ///< as the version before
};

/// Writes what changed. Where another station wrote meanwhile, its fields and ours are laid
/// together, so that neither is lost.
/// @errors StepNotAllowed (no draft any more), those of editVisit
[[nodiscard]] Expected<FormSaved> saveForm(Store& store, const FormEdit& edit);

}  // namespace tarsus
