#include "measurement/report/visit_rows.h"

#include "measurement/records/record_json.h"
#include "measurement/records/visit_fields.h"
#include "measurement/scores/score_json.h"

#include <nlohmann/json.hpp>

#include <array>
#include <set>

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

/// Fields that differ between two versions, in the form's order.
std::vector<ReportAmendment> amendmentsBetween(const Visit& before,
                                               const Visit& after,
                                               const NameOfUser& name_of) {
  std::set<std::string> names;
  for (const auto* visit : {&before, &after}) {
    for (const auto& [name, value] : visit->content.fields.items()) {
      names.insert(name);
    }
  }
  std::vector<ReportAmendment> amendments;
  const auto add = [&](const std::string& field, const std::string& from, const std::string& to) {
    if (from != to) {
      amendments.push_back({.version = static_cast<int>(after.revision),
                            .field = field,
                            .old_value = from,
                            .new_value = to,
                            .reason = after.reason,
                            .effect = {},
                            .who = name_of(after.author),
                            .when = isoTime(after.at_ms)});
    }
  };
  for (const std::string& name : names) {
    add(name, fieldOf(before, name), fieldOf(after, name));
  }
  add("wound", before.wound_id, after.wound_id);
  return amendments;
}

}  // namespace

Expected<void> addFindings(const Visit& visit, const NameOfUser& name_of, ReportContent& content) {
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
    return text.empty()
               ? ReportText{}
               : ReportText{
                     .text = text, .who = name_of(visit.author), .when = isoTime(visit.at_ms)};
  };
  content.notes = typed("notes");
  content.plan = typed("plan");
  return {};
}

void addHistory(std::span<const Visit> versions,
                const NameOfUser& name_of,
                ReportContent& content) {
  for (std::size_t i = 0; i < versions.size(); ++i) {
    const Visit& version = versions[i];
    const auto sign = [&](SignatureStep step) {
      content.signatures.push_back({.version = static_cast<int>(version.revision),
                                    .step = step,
                                    .who = name_of(version.author),
                                    .when = isoTime(version.at_ms),
                                    .key = {}});
    };
    if (version.last_action == "sign") {
      sign(SignatureStep::Signed);
    } else if (version.last_action == "return") {
      sign(SignatureStep::Returned);
    } else if (version.last_action == "review") {
      sign(SignatureStep::Countersigned);
    } else if (i > 0 && version.state == VisitState::Amended) {
      sign(SignatureStep::Signed);
      const auto amendments = amendmentsBetween(versions[i - 1], version, name_of);
      content.amendments.insert(content.amendments.end(), amendments.begin(), amendments.end());
    }
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
