#pragma once

#include "reconstruction/base/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace tarsus {

enum class ItemSource : std::uint8_t { Clinician, Model };

/// One input of a score. What a clinician enters is confirmed by that; what is proposed from the
/// model counts only once a clinician has confirmed it.
template <typename T>
struct ScoreItem {
  std::optional<T> value;  ///< empty: not known
  ItemSource source = ItemSource::Clinician;
  bool confirmed = true;

  ScoreItem() = default;
  ScoreItem(T entered) : value(entered) {}  // NOLINT(google-explicit-constructor): reads as entered

  [[nodiscard]] static ScoreItem proposed(T from_model) {
    ScoreItem item(from_model);
    item.source = ItemSource::Model;
    item.confirmed = false;
    return item;
  }
  /// What the rule may use.
  [[nodiscard]] std::optional<T> usable() const { return confirmed ? value : std::nullopt; }
};

/// An input as it was given.
struct ScoreInput {
  std::string name;
  std::variant<bool, double, std::string> value;
  ItemSource source = ItemSource::Clinician;
  bool confirmed = true;
};

struct ScoreComponent {
  std::string name;
  std::optional<int> points;  ///< empty: its input is missing
  std::string meaning;        ///< in our own short words
};

/// What a named rule says about the inputs; never a judgement of ours.
struct ScoreResult {
  std::string score;  ///< short name, as on the command line
  std::string title;
  std::string rule;  ///< name and version of the rule as it is programmed
  std::string citation;
  std::optional<int> points;  ///< sum, grade or stage; empty: not computable
  std::string outcome;        ///< the whole result as it is spoken; empty: not computable
  std::vector<ScoreComponent> components;
  std::vector<ScoreInput> inputs;        ///< all that were given
  std::vector<std::string> missing;      ///< needed, not given
  std::vector<std::string> unconfirmed;  ///< needed, proposed, not confirmed
  std::string not_computable;            ///< why; empty where there is a result
};

}  // namespace tarsus
