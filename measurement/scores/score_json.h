#pragma once

#include "measurement/scores/scores.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string_view>

namespace tarsus {

/// The short names of all scores, as on the command line.
[[nodiscard]] std::span<const std::string_view> scoreNames();

/// Reads inputs and applies the rule.
/// An input is its value, or {"value", "source": "clinician" or "model", "confirmed"}; null or left
/// out: not known. What comes from the model is not confirmed unless it says so.
/// @param score  one of scoreNames()
/// @errors ScoreInputInvalid (not an object, a key or word that does not exist, out of range)
[[nodiscard]] Expected<ScoreResult> scoreFromJson(std::string_view score,
                                                  const nlohmann::json& input);

/// The inputs of one score; for the six input types of scores.h.
template <typename Input>
[[nodiscard]] Expected<Input> scoreInputFromJson(const nlohmann::json& input);
template <typename Input>
[[nodiscard]] nlohmann::json scoreInputToJson(const Input& input);

[[nodiscard]] nlohmann::json toJson(const ScoreResult& result);

}  // namespace tarsus
