#include "measurement/records/visit_fields.h"

#include "measurement/scores/score_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr VisitField text(std::string_view name) { return {.name = name}; }
constexpr VisitField flag(std::string_view name) { return {.name = name, .type = FieldType::Flag}; }
constexpr VisitField number(std::string_view name, double least, double most) {
  return {.name = name, .type = FieldType::Number, .least = least, .most = most};
}
constexpr VisitField count(std::string_view name, double most) {
  return {.name = name, .type = FieldType::Number, .most = most, .is_whole = true};
}
constexpr VisitField words(std::string_view name, std::string_view choice) {
  return {.name = name, .type = FieldType::Words, .words = choice};
}
constexpr VisitField typed(std::string_view name, double most) {
  return {.name = name, .type = FieldType::Number, .most = most, .is_typed_measure = true};
}
constexpr VisitField clockRanges(std::string_view name) {
  return {.name = name, .type = FieldType::ClockRanges};
}

constexpr double kLongestMm = 400.0;  // longer than a foot

constexpr std::array kFields{
    words("pulse_dorsalis_pedis", "present weak absent"),
    words("pulse_tibialis_posterior", "present weak absent"),
    number("abi", 0.0, 3.0),
    number("toe_pressure_mmhg", 0.0, 350.0),
    count("monofilament_felt_of_10", 10.0),
    words("probe_to_bone", "positive negative"),
    flag("infection_swelling_or_induration"),
    number("infection_erythema_cm", 0.0, 60.0),
    flag("infection_tenderness_or_pain"),
    flag("infection_warmth"),
    flag("infection_pus"),
    words("exudate_amount", "none light moderate heavy"),
    words("exudate_type", "serous sanguineous serosanguineous purulent"),
    words("exudate_odour", "none faint strong"),
    words("edge", "flat sloping punched_out rolled undermined"),
    words("callus", "none light thick"),
    words("periwound", "healthy red macerated dry eczema swollen"),
    number("pain_of_10", 0.0, 10.0),
    words("debridement", "none before_scan after_scan"),
    text("offloading"),
    words("offloading_adherence", "always mostly sometimes never"),
    text("dressing"),
    number("hba1c_percent", 3.0, 20.0),
    typed("ruler_length_mm", kLongestMm),
    typed("ruler_width_mm", kLongestMm),
    typed("probe_depth_mm", kLongestMm),
    clockRanges("undermining"),
    clockRanges("tunnels"),
    text("notes"),
    text("plan"),
};

Expected<void> invalid(std::string_view name, const std::string& what) {
  return fail(ErrorCode::RecordInvalid, "\"" + std::string(name) + "\" " + what);
}

std::string shortNumber(double value) {
  std::string digits = std::to_string(value);
  digits.erase(digits.find_last_not_of('0') + 1);
  return digits.ends_with('.') ? digits.substr(0, digits.size() - 1) : digits;
}

bool isWithin(const json& value, double least, double most) {
  return value.is_number() && std::isfinite(value.get<double>()) && value.get<double>() >= least &&
         value.get<double>() <= most;
}

bool isChosen(std::string_view choice, const json& value) {
  if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
    return false;
  }
  const std::string padded = " " + std::string(choice) + " ";
  const std::string word = " " + value.get<std::string>() + " ";
  return std::ranges::count(word, ' ') == 2 && padded.find(word) != std::string::npos;
}

/// [{"from_clock": 1..12, "to_clock": 1..12, "depth_mm"}]; heel 12, toes 6.
bool areClockRanges(const json& value) {
  return value.is_array() && std::ranges::all_of(value, [](const json& range) {
           return range.is_object() && range.size() == 3 && range.contains("from_clock") &&
                  range.contains("to_clock") && range.contains("depth_mm") &&
                  isWithin(range["from_clock"], 1.0, 12.0) &&
                  isWithin(range["to_clock"], 1.0, 12.0) &&
                  isWithin(range["depth_mm"], 0.0, kLongestMm);
         });
}

Expected<void> checkField(const VisitField& field, const json& value) {
  constexpr std::size_t kLongestText = 20000;
  switch (field.type) {
    case FieldType::Text:
      return value.is_string() && value.get_ref<const std::string&>().size() <= kLongestText
                 ? Expected<void>()
                 : invalid(field.name, "must be a text of at most 20000 letters");
    case FieldType::Flag:
      return value.is_boolean() ? Expected<void>() : invalid(field.name, "must be true or false");
    case FieldType::Number:
      return isWithin(value, field.least, field.most) &&
                     (!field.is_whole || value.get<double>() == std::floor(value.get<double>()))
                 ? Expected<void>()
                 : invalid(field.name,
                           std::string("must be a ") + (field.is_whole ? "whole " : "") +
                               "number from " + shortNumber(field.least) + " to " +
                               shortNumber(field.most));
    case FieldType::Words:
      return isChosen(field.words, value)
                 ? Expected<void>()
                 : invalid(field.name, "must be one of: " + std::string(field.words));
    case FieldType::ClockRanges:
      return areClockRanges(value)
                 ? Expected<void>()
                 : invalid(field.name,
                           "must be a list of {from_clock, to_clock, depth_mm} by the clock, 1 to "
                           "12");
  }
  return {};
}

Expected<void> checkScores(const json& scores) {
  if (!scores.is_object()) {
    return invalid("scores", "must be an object with the items of each score by its name");
  }
  for (const auto& [name, items] : scores.items()) {
    if (std::ranges::find(scoreNames(), name) == scoreNames().end()) {
      return invalid(name, "is no score that is known");
    }
    if (const auto result = scoreFromJson(name, items); !result) {
      return invalid(name, "cannot be read: " + result.error().detail);
    }
  }
  return {};
}

}  // namespace

std::span<const VisitField> visitFields() { return kFields; }

Expected<void> checkVisitFields(const json& fields, bool usable_scan) {
  if (!fields.is_object()) {
    return fail(ErrorCode::RecordInvalid, "a visit's fields must be one JSON object");
  }
  bool is_typed = false;
  for (const auto& [name, value] : fields.items()) {
    if (name == "scores") {
      if (auto usable = checkScores(value); !usable) {
        return usable;
      }
      continue;
    }
    const auto* const field = std::ranges::find(kFields, name, &VisitField::name);
    if (field == kFields.end()) {
      return invalid(name, "is no field of a visit");
    }
    if (auto usable = checkField(*field, value); !usable) {
      return usable;
    }
    is_typed = is_typed || field->is_typed_measure;
  }
  return usable_scan || is_typed
             ? Expected<void>()
             : fail(ErrorCode::RecordInvalid,
                    "a visit without a usable scan needs a typed measure: ruler_length_mm, "
                    "ruler_width_mm or probe_depth_mm");
}

}  // namespace tarsus
