#include "measurement/report/visit_rows.h"

#include "measurement/records/record_json.h"
#include "measurement/records/visit_fields.h"
#include "measurement/scores/score_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>

namespace tarsus {
namespace {

using nlohmann::json;

std::string textOf(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "" : value.dump();
}

std::string fieldOf(const Visit& visit, const std::string& name) {
  const auto found = visit.content.fields.find(name);
  return found == visit.content.fields.end() ? std::string() : textOf(*found);
}

std::vector<ClockRange> clockRanges(const json& list) {
  std::vector<ClockRange> ranges;
  for (const json& range : list) {
    ranges.push_back({.from_clock = range.value("from_clock", 12.0),
                      .to_clock = range.value("to_clock", 12.0),
                      .depth_mm = range.value("depth_mm", 0.0)});
  }
  return ranges;
}

/// Of the five local signs; nothing unless all were looked for.
std::optional<int> infectionSigns(const json& fields) {
  constexpr double kErythema_cm = 0.5;
  int signs = 0;
  for (const char* name : {"infection_swelling_or_induration",
                           "infection_tenderness_or_pain",
                           "infection_warmth",
                           "infection_pus"}) {
    if (!fields.contains(name) || !fields.at(name).is_boolean()) {
      return std::nullopt;
    }
    signs += fields.at(name).get<bool>() ? 1 : 0;
  }
  const auto erythema = fields.find("infection_erythema_cm");
  if (erythema == fields.end() || !erythema->is_number()) {
    return std::nullopt;
  }
  return signs + (erythema->get<double>() > kErythema_cm ? 1 : 0);
}

/// "10-1: 8 mm", the hours and the depth of each.
std::string rangesText(const json& ranges) {
  std::string text;
  for (const json& range : ranges) {
    const auto number = [&](const char* key) {
      return range.is_object() && range.contains(key) ? range.at(key).dump() : std::string();
    };
    text += (text.empty() ? "" : ", ") + number("from_clock") + "\u2013" + number("to_clock") +
            ": " + number("depth_mm") + " mm";
  }
  return text;
}

ChangedKind kindOf(const json& value) {
  return value.is_number()    ? ChangedKind::Number
         : value.is_boolean() ? ChangedKind::Word
                              : ChangedKind::Text;
}

/// The form's fields by name; each item of a score by "name: item".
std::map<std::string, json> flatFields(const Visit& visit) {
  std::map<std::string, json> flat;
  for (const auto& [name, value] : visit.content.fields.items()) {
    if (name == "scores" && value.is_object()) {
      for (const auto& [score, items] : value.items()) {
        for (const auto& [item, answer] : items.items()) {
          flat[score + ": " + item] = answer;
        }
      }
    } else {
      flat[name] = value;
    }
  }
  return flat;
}

ReportChange changeOf(const std::string& name, const json& before, const json& after) {
  ReportChange change{.field = name, .old_value = textOf(before), .new_value = textOf(after)};
  change.kind = kindOf(after.is_null() ? before : after);
  const auto fields = visitFields();
  const auto field = std::ranges::find(fields, name, &VisitField::name);
  if (field != fields.end() && field->type == FieldType::Words) {
    change.kind = ChangedKind::Word;
  }
  if (field != fields.end() && field->type == FieldType::ClockRanges) {
    change.old_value = rangesText(before);
    change.new_value = rangesText(after);
  }
  return change;
}

/// Titles of a visit's files of these roles.
std::string titlesOf(const Visit& visit, bool pictures) {
  std::string titles;
  for (const VisitFile& file : visit.content.files) {
    if ((file.role == "picture") == pictures) {
      titles += (titles.empty() ? "" : ", ") + (pictures ? file.title : file.role);
    }
  }
  return titles;
}

/// Whether other files stand behind one title.
std::vector<std::string> fileNames(const Visit& visit, bool pictures) {
  std::vector<std::string> names;
  for (const VisitFile& file : visit.content.files) {
    if ((file.role == "picture") == pictures) {
      names.push_back(file.name);
    }
  }
  return names;
}

/// What differs between two versions.
/// @param measured_next  the next version is the measurement of the files that this one changes
std::vector<ReportChange> changesBetween(const Visit& before,
                                         const Visit& after,
                                         const HistoryNames& names,
                                         bool measured_next) {
  std::vector<ReportChange> changes;
  if (before.content.taken_at_ms != after.content.taken_at_ms) {
    changes.push_back({"taken_at",
                       isoTime(before.content.taken_at_ms),
                       isoTime(after.content.taken_at_ms),
                       ChangedKind::Time});
  }
  if (before.content.usable_scan != after.content.usable_scan) {
    changes.push_back(
        changeOf("usable_scan", before.content.usable_scan, after.content.usable_scan));
  }
  if (before.wound_id != after.wound_id) {
    changes.push_back(
        {"wound", names.wound(before.wound_id), names.wound(after.wound_id), ChangedKind::Wound});
  }
  auto old_fields = flatFields(before);
  auto new_fields = flatFields(after);
  for (const auto& [name, value] : new_fields) {
    old_fields.try_emplace(name, nullptr);
  }
  for (const auto& [name, value] : old_fields) {
    if (new_fields[name] != value) {
      changes.push_back(changeOf(name, value, new_fields[name]));
    }
  }
  if (fileNames(before, true) != fileNames(after, true)) {
    changes.push_back({"pictures", titlesOf(before, true), titlesOf(after, true)});
  }
  if (!measured_next && fileNames(before, false) != fileNames(after, false)) {
    changes.push_back({"files", titlesOf(before, false), titlesOf(after, false)});
  }
  return changes;
}

/// Who last changed a field, and when; the first version where nobody did.
const Visit& lastChangeOf(std::span<const Visit> versions, const std::string& field) {
  std::size_t at = 0;
  for (std::size_t i = 1; i < versions.size(); ++i) {
    at = fieldOf(versions[i - 1], field) != fieldOf(versions[i], field) ? i : at;
  }
  return versions[at];
}

std::optional<double> millimetres(const json& fields, const char* name) {
  const auto found = fields.find(name);
  return found != fields.end() && found->is_number() ? std::optional(found->get<double>())
                                                     : std::nullopt;
}

}  // namespace

Expected<void> addFindings(std::span<const Visit> versions,
                           const NameOfUser& name_of,
                           ReportContent& content) {
  const Visit& visit = versions.back();
  // In clinical.md's order; what was not entered is said so on the page.
  constexpr std::array kRows{"exudate_amount",
                             "exudate_type",
                             "exudate_odour",
                             "edge",
                             "callus",
                             "periwound",
                             "pain_of_10",
                             "probe_to_bone",
                             "debridement",
                             "offloading",
                             "offloading_adherence",
                             "dressing"};
  for (const char* row : kRows) {
    content.findings.rows.emplace_back(row, fieldOf(visit, row));
  }
  const json& fields = visit.content.fields;
  if (const auto ranges = fields.find("undermining"); ranges != fields.end()) {
    content.findings.undermining = clockRanges(*ranges);
    content.findings.undermining_recorded = true;
  }
  if (const auto ranges = fields.find("tunnels"); ranges != fields.end()) {
    content.findings.tunnels = clockRanges(*ranges);
    content.findings.tunnels_recorded = true;
  }
  content.findings.infection_signs = infectionSigns(fields);
  content.findings.ruler_length_mm = millimetres(fields, "ruler_length_mm");
  content.findings.ruler_width_mm = millimetres(fields, "ruler_width_mm");
  content.findings.probe_depth_mm = millimetres(fields, "probe_depth_mm");
  const json scores = fields.value("scores", json::object());
  for (const auto& [score, items] : scores.items()) {
    auto result = scoreFromJson(score, items);
    if (!result) {
      return tl::unexpected(result.error());
    }
    content.scores.push_back(std::move(*result));
  }
  const auto typed = [&](const char* name) {
    const std::string text = fieldOf(visit, name);
    const Visit& by = lastChangeOf(versions, name);
    return text.empty()
               ? ReportText{}
               : ReportText{.text = text, .who = name_of(by.author), .when = isoTime(by.at_ms)};
  };
  content.notes = typed("notes");
  content.plan = typed("plan");
  return {};
}

void addHistory(std::span<const Visit> versions,
                std::span<const Measurement> measurements,
                const HistoryNames& names,
                ReportContent& content) {
  std::size_t measured = 0;  // each version "measure" has its measurement
  for (std::size_t i = 0; i < versions.size(); ++i) {
    const Visit& version = versions[i];
    const std::string& action = version.last_action;
    const std::size_t number = action == "measure" ? measured++ : 0;
    const auto sign = [&](SignatureStep step) {
      content.signatures.push_back({.version = static_cast<int>(version.revision),
                                    .step = step,
                                    .who = names.user(version.author),
                                    .when = isoTime(version.at_ms),
                                    .key = {},
                                    .reason = version.reason});
    };
    if (action == "sign") {
      sign(SignatureStep::Signed);
    } else if (action == "return") {
      sign(SignatureStep::Returned);
    } else if (action == "review") {
      sign(SignatureStep::Countersigned);
    }
    const bool amends = action == "amend" || action == "move" || action == "measure";
    if (i == 0 || version.state != VisitState::Amended || !amends) {
      continue;  // a draft, or moved into or out of the trash
    }
    const bool measured_next = i + 1 < versions.size() && versions[i + 1].last_action == "measure";
    ReportAmendment amendment{
        .version = static_cast<int>(version.revision),
        .changes = changesBetween(versions[i - 1], version, names, measured_next),
        .measured = std::nullopt,
        .reason = version.reason,
        .effect = {},
        .who = names.user(version.author),
        .when = isoTime(version.at_ms)};
    if (action == "measure" && number < measurements.size()) {
      amendment.measured = ReportRemeasurement{
          .before = number > 0
                        ? std::optional(measurementFromJson(measurements[number - 1].numbers))
                        : std::nullopt,
          .now = measurementFromJson(measurements[number].numbers)};
    }
    // Measuring puts its files with the visit in a version of its own: one amendment, not two.
    if (action == "amend" && measured_next && amendment.changes.empty()) {
      continue;
    }
    content.amendments.push_back(std::move(amendment));
  }
}

void addEvents(std::span<const Visit> visits, ReportContent& content) {
  std::string offloading;
  for (const Visit& visit : visits) {
    const std::string date = isoTime(visit.content.taken_at_ms);
    const std::string now = fieldOf(visit, "offloading");
    if (!now.empty() && now != offloading) {
      content.events.push_back({.date = date, .text = now, .major = true});
      offloading = now;
    }
    const std::string debridement = fieldOf(visit, "debridement");
    if (debridement == "before_scan" || debridement == "after_scan") {
      content.events.push_back({.date = date, .text = "debridement", .major = true});
    }
  }
}

}  // namespace tarsus
