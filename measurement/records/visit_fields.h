#pragma once

#include "reconstruction/base/error.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string_view>

namespace tarsus {

enum class FieldType { Text, Flag, Number, Words, ClockRanges };

/// One field of the visit's form. What is not known is left out, never written as 0.
struct VisitField {
  std::string_view name;
  FieldType type = FieldType::Text;
  double least = 0.0;  ///< of a Number: what lies outside is a slip of unit or of the pen
  double most = 0.0;
  std::string_view words = {};    ///< of Words, parted by spaces; exactly one is chosen
  bool is_typed_measure = false;  ///< by ruler or probe
  bool is_whole = false;          ///< of a Number: a count
};

/// All fields, in the order of the form (clinical.md section 5).
[[nodiscard]] std::span<const VisitField> visitFields();

/// Checks each field of a visit's document; "scores" holds the items of published scores by the
/// score's name and is checked by their own rules.
/// @param usable_scan  without one, at least one typed measure must be there
/// @errors RecordInvalid, naming the field and what it must be
[[nodiscard]] Expected<void> checkVisitFields(const nlohmann::json& fields, bool usable_scan);

}  // namespace tarsus
