#include "measurement/scores/score_json.h"

#include "measurement/scores/score_items.h"
#include "reconstruction/base/require.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <set>

namespace tarsus {
namespace {

using nlohmann::json;

/// Letters to insert, delete or replace between two words (Levenshtein 1966).
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string nearest(std::string_view word, const std::vector<std::string_view>& names) {
  const auto distance = [&](std::string_view name) { return editDistance(word, name); };
  return std::string(*std::ranges::min_element(names, {}, distance));
}

std::string inQuotes(std::string_view text) {
  std::size_t length = std::min<std::size_t>(text.size(), 40);
  const auto continues = [&](std::size_t i) {  // within a letter of UTF-8
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (length > 0 && continues(length)) {
    --length;
  }
  return '"' + std::string(text.substr(0, length)) + '"';
}

template <std::size_t N>
std::string listed(const std::array<std::string_view, N>& words) {
  std::string all;
  for (const std::string_view word : words) {
    all += (all.empty() ? "" : ", ") + std::string(word);
  }
  return all;
}

/// What stands in `value` as a T, or the sentence why it cannot.
std::string readValue(std::string_view name, const json& value, std::optional<double>& out) {
  if (!value.is_number()) {
    return std::string(name) + " must be a number";
  }
  out = value.get<double>();
  return {};
}

std::string readValue(std::string_view name, const json& value, std::optional<bool>& out) {
  if (!value.is_boolean()) {
    return std::string(name) + " must be true or false";
  }
  out = value.get<bool>();
  return {};
}

template <typename E>
requires std::is_enum_v<E> std::string readValue(std::string_view name,
                                                 const json& value,
                                                 std::optional<E>& out) {
  const auto& words = kWords<E>;
  const auto word =
      value.is_string() ? std::ranges::find(words, value.get<std::string>()) : words.end();
  if (word == words.end()) {
    return std::string(name) + " must be one of " + listed(words);
  }
  out = static_cast<E>(word - words.begin());
  return {};
}

template <typename T>
std::string readItem(std::string_view name, const json& entry, ScoreItem<T>& item) {
  if (entry.is_null()) {
    return {};
  }
  if (!entry.is_object()) {
    return readValue(name, entry, item.value);
  }
  for (const auto& [key, value] : entry.items()) {
    if (key != "value" && key != "source" && key != "confirmed") {
      return std::string(name) + " has the unknown key " + inQuotes(key) +
             "; it may have value, source and confirmed";
    }
  }
  const json source = entry.value("source", json("clinician"));
  if (source != "clinician" && source != "model") {
    return "the source of " + std::string(name) + " must be clinician or model";
  }
  item.source = source == "model" ? ItemSource::Model : ItemSource::Clinician;
  const json confirmed = entry.value("confirmed", json(item.source == ItemSource::Clinician));
  if (!confirmed.is_boolean()) {
    return "confirmed of " + std::string(name) + " must be true or false";
  }
  item.confirmed = confirmed.get<bool>();
  const json value = entry.value("value", json());
  return value.is_null() ? std::string() : readValue(name, value, item.value);
}

template <typename T>
json valueJson(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return kWords<T>.at(static_cast<std::size_t>(value));
  } else {
    return value;
  }
}

const char* nameOf(ItemSource source) {
  return source == ItemSource::Model ? "model" : "clinician";
}

template <typename Input>
Expected<ScoreResult> scored(const json& document,
                             Expected<ScoreResult> (*rule)(const Input& input)) {
  const auto input = scoreInputFromJson<Input>(document);
  return input ? rule(*input) : tl::unexpected(input.error());
}

constexpr std::array<std::string_view, 6> kNames{
    "sinbad", "wagner", "texas", "infection", "wifi", "push"};

}  // namespace

std::span<const std::string_view> scoreNames() { return kNames; }

template <typename Input>
Expected<Input> scoreInputFromJson(const json& document) {
  if (!document.is_object()) {
    return fail(ErrorCode::ScoreInputInvalid, "an object with the score's items was expected");
  }
  Input input;
  std::string wrong;
  std::vector<std::string_view> names;
  forEachItem(input, [&](const ItemFacts& facts, auto& item) {
    names.push_back(facts.name);
    const auto entry = document.find(facts.name);
    if (wrong.empty() && entry != document.end()) {
      wrong = readItem(facts.name, *entry, item);
    }
  });
  for (const auto& [key, value] : document.items()) {
    if (std::ranges::find(names, key) == names.end()) {
      return fail(
          ErrorCode::ScoreInputInvalid,
          "unknown key " + inQuotes(key) + "; did you mean " + inQuotes(nearest(key, names)) + "?");
    }
  }
  if (!wrong.empty()) {
    return fail(ErrorCode::ScoreInputInvalid, wrong);
  }
  return input;
}

template <typename Input>
json scoreInputToJson(const Input& input) {
  json document = json::object();
  forEachItem(input, [&](const ItemFacts& facts, const auto& item) {
    if (item.value) {
      document[std::string(facts.name)] = {{"value", valueJson(*item.value)},
                                           {"source", nameOf(item.source)},
                                           {"confirmed", item.confirmed}};
    }
  });
  return document;
}

template Expected<SinbadInput> scoreInputFromJson(const json&);
template Expected<WagnerInput> scoreInputFromJson(const json&);
template Expected<TexasInput> scoreInputFromJson(const json&);
template Expected<InfectionInput> scoreInputFromJson(const json&);
template Expected<WifiInput> scoreInputFromJson(const json&);
template Expected<PushInput> scoreInputFromJson(const json&);
template json scoreInputToJson(const SinbadInput&);
template json scoreInputToJson(const WagnerInput&);
template json scoreInputToJson(const TexasInput&);
template json scoreInputToJson(const InfectionInput&);
template json scoreInputToJson(const WifiInput&);
template json scoreInputToJson(const PushInput&);

Expected<ScoreResult> scoreFromJson(std::string_view score, const json& input) {
  const auto which = std::ranges::find(kNames, score) - kNames.begin();
  switch (which) {
    case 0:
      return scored(input, scoreSinbad);
    case 1:
      return scored(input, scoreWagner);
    case 2:
      return scored(input, scoreTexas);
    case 3:
      return scored(input, scoreInfection);
    case 4:
      return scored(input, scoreWifi);
    case 5:
      return scored(input, scorePush);
    default:
      break;
  }
  TARSUS_REQUIRE(false, "one of scoreNames()");
  return {};
}

json toJson(const ScoreResult& result) {
  const auto orNull = [](const std::string& text) { return text.empty() ? json() : json(text); };
  json components = json::array();
  for (const ScoreComponent& c : result.components) {
    components.push_back({{"name", c.name},
                          {"points", c.points ? json(*c.points) : json()},
                          {"meaning", orNull(c.meaning)}});
  }
  json inputs = json::object();
  for (const ScoreInput& input : result.inputs) {
    inputs[input.name] = {
        {"value", std::visit([](const auto& value) { return json(value); }, input.value)},
        {"source", nameOf(input.source)},
        {"confirmed", input.confirmed}};
  }
  return {{"score", result.score},
          {"title", result.title},
          {"points", result.points ? json(*result.points) : json()},
          {"outcome", orNull(result.outcome)},
          {"components", components},
          {"inputs", inputs},
          {"missing", result.missing},
          {"unconfirmed", result.unconfirmed},
          {"not_computable", orNull(result.not_computable)},
          {"rule", result.rule},
          {"citation", result.citation}};
}

}  // namespace tarsus
