#include "measurement/scores/scoring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

std::string text(double value) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%g", value);
  return digits.data();
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) {
    all += (all.empty() ? "" : ", ") + name;
  }
  return all;
}

}  // namespace

Scoring::Scoring(const ScoreRule& rule) {
  result_.score = rule.score;
  result_.title = rule.title;
  result_.rule = rule.rule;
  result_.citation = rule.citation;
}

void Scoring::refuse(std::string sentence) {
  if (refusal_.empty()) {
    refusal_ = std::move(sentence);
  }
}

void Scoring::checkRange(const ItemFacts& facts, double value) {
  if (!(std::isfinite(value) && value >= facts.least && value <= facts.most)) {
    refuse(std::string(facts.name) + " must lie between " + text(facts.least) + " and " +
           text(facts.most) + " " + std::string(facts.unit) + ", not " + text(value));
  }
}

void Scoring::component(std::string_view name,
                        std::optional<int> points,
                        std::string_view meaning) {
  result_.components.push_back({std::string(name), points, std::string(points ? meaning : "")});
}

void Scoring::yesNo(std::string_view name,
                    const std::optional<bool>& value,
                    std::string_view if_no,
                    std::string_view if_yes) {
  const bool yes = value.value_or(false);
  component(name, value ? std::optional(yes ? 1 : 0) : std::nullopt, yes ? if_yes : if_no);
}

bool Scoring::complete(const std::vector<std::string_view>& needed) {
  for (const std::string_view name : needed) {
    const auto input = std::ranges::find(result_.inputs, name, &ScoreInput::name);
    if (input == result_.inputs.end()) {
      result_.missing.emplace_back(name);
    } else if (!input->confirmed) {
      result_.unconfirmed.emplace_back(name);
    }
  }
  result_.not_computable = whyIncomplete();
  return result_.not_computable.empty();
}

std::string Scoring::whyIncomplete() const {
  std::string why;
  if (!result_.missing.empty()) {
    why = "missing: " + joined(result_.missing);
  }
  if (!result_.unconfirmed.empty()) {
    why += (why.empty() ? "" : "; ") + ("not confirmed: " + joined(result_.unconfirmed));
  }
  return why;
}

void Scoring::outcome(int points, std::string spoken) {
  result_.points = points;
  result_.outcome = std::move(spoken);
}

Expected<ScoreResult> Scoring::finish() {
  if (!refusal_.empty()) {
    return fail(ErrorCode::ScoreInputInvalid, refusal_);
  }
  return std::move(result_);
}

}  // namespace tarsus
