#pragma once

// What all rules share: looking over the inputs, components, what is missing.

#include "measurement/scores/score_items.h"

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

struct ScoreRule {
  std::string_view score;
  std::string_view title;
  std::string_view rule;
  std::string_view citation;
};

/// A result without outcome: names and, for each item, the value as given.
class Scoring {
 public:
  template <typename Input>
  Scoring(const ScoreRule& rule, const Input& input) : Scoring(rule) {
    forEachItem(input, [this](const ItemFacts& facts, const auto& item) { take(facts, item); });
  }

  /// Refuses the inputs from here on; the first reason stays.
  void refuse(std::string sentence);
  [[nodiscard]] bool refused() const { return !refusal_.empty(); }
  /// A component; empty points where its input is missing.
  void component(std::string_view name, std::optional<int> points, std::string_view meaning);
  /// Two-valued component: 0 or 1.
  void yesNo(std::string_view name,
             const std::optional<bool>& value,
             std::string_view if_no,
             std::string_view if_yes);
  /// Whether all of these can be used; what cannot is noted as the reason.
  [[nodiscard]] bool complete(const std::vector<std::string_view>& needed);
  void miss(std::string name) { result_.missing.push_back(std::move(name)); }
  void notComputable(std::string reason) { result_.not_computable = std::move(reason); }
  void outcome(int points, std::string spoken);
  [[nodiscard]] Expected<ScoreResult> finish();

 private:
  explicit Scoring(const ScoreRule& rule);
  void checkRange(const ItemFacts& facts, double value);
  [[nodiscard]] std::string whyIncomplete() const;

  template <typename T>
  void take(const ItemFacts& facts, const ScoreItem<T>& item) {
    if (!item.value) {
      return;
    }
    ScoreInput input{.name = std::string(facts.name),
                     .value = {},
                     .source = item.source,
                     .confirmed = item.confirmed};
    if constexpr (std::is_enum_v<T>) {
      input.value = std::string(kWords<T>.at(static_cast<std::size_t>(*item.value)));
    } else {
      input.value = *item.value;
    }
    if constexpr (std::is_same_v<T, double>) {
      checkRange(facts, *item.value);
    }
    result_.inputs.push_back(std::move(input));
  }

  ScoreResult result_;
  std::string refusal_;
};

}  // namespace tarsus
