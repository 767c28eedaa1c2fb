#include "ui/work/visit_facts.h"

#include "ui/work/patient_summary.h"

#include <algorithm>
#include <set>

namespace tarsus {
namespace {

using nlohmann::json;

template <typename Record>
const Record* withId(const std::vector<Record>& records, const std::string& id) {
  const auto found = std::ranges::find(records, id, &Record::id);
  return found == records.end() ? nullptr : &*found;
}

/// Earlier visits of the wound, oldest first.
std::vector<const Visit*> visitsBefore(const PatientHistory& history, const Visit& visit) {
  std::vector<const Visit*> before;
  for (const Visit& other : history.visits) {
    if (other.id == visit.id) {
      break;
    }
    if (other.wound_id == visit.wound_id) {
      before.push_back(&other);
    }
  }
  return before;
}

json fieldOf(const json& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? json() : *found;
}

}  // namespace

Expected<VisitFacts> visitFacts(Store& store, const std::string& visit_id) {
  auto visit = findVisit(store, visit_id);
  if (!visit) {
    return tl::unexpected(visit.error());
  }
  const auto patient = patientOf(store, *visit);
  if (!patient) {
    return tl::unexpected(patient.error());
  }
  auto history = patientHistory(store, *patient);
  if (!history) {
    return tl::unexpected(history.error());
  }
  const Wound* wound = withId(history->wounds, visit->wound_id);
  const Foot* foot = wound == nullptr ? nullptr : withId(history->feet, wound->foot_id);
  if (foot == nullptr) {
    return fail(ErrorCode::RecordMissing, "the wound of this visit");
  }
  VisitFacts facts{.visit = *visit,
                   .patient = history->patient,
                   .foot = *foot,
                   .wound = *wound,
                   .last_visit = {},
                   .earlier = {}};
  const auto before = visitsBefore(*history, *visit);
  for (const Visit* other : before) {
    facts.last_visit = other->id;
    for (const auto& [name, value] : other->content.fields.items()) {
      facts.earlier[name] = {value, dateAt(other->content.taken_at_ms)};
    }
  }
  if (!before.empty()) {
    const auto days =
        dateAt(before.front()->content.taken_at_ms).daysTo(dateAt(visit->content.taken_at_ms));
    facts.week = static_cast<int>(days / 7);
  }
  return facts;
}

Expected<FormSaved> saveForm(Store& store, const FormEdit& edit) {
  auto current = findVisit(store, edit.visit_id);
  if (!current) {
    return tl::unexpected(current.error());
  }
  if (current->state != VisitState::Draft) {
    return fail(ErrorCode::StepNotAllowed, "the visit is no draft any more");
  }
  FormSaved saved{.visit = {}, .merged = current->revision != edit.base_revision, .disputed = {}};
  const json theirs = current->content.fields;
  std::set<std::string> names;
  for (const json* form : {&edit.before, &edit.now}) {
    for (const auto& [name, value] : form->items()) {
      names.insert(name);
    }
  }
  VisitContent content = current->content;
  for (const std::string& name : names) {
    const json mine = fieldOf(edit.now, name);
    const json base = fieldOf(edit.before, name);
    const json other = fieldOf(theirs, name);
    if (mine == base) {
      continue;
    }
    if (other != base && other != mine) {
      saved.disputed.push_back(name);
    }
    if (mine.is_null()) {
      content.fields.erase(name);
    } else {
      content.fields[name] = mine;
    }
  }
  content.usable_scan = edit.usable_scan;
  auto written = editVisit(store, edit.visit_id, current->revision, content);
  if (!written) {
    return tl::unexpected(written.error());
  }
  saved.visit = std::move(*written);
  return saved;
}

}  // namespace tarsus
