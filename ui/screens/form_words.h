#pragma once

#include <QString>

#include <nlohmann/json_fwd.hpp>

#include <string_view>
#include <vector>

namespace tarsus {

/// A section of the visit's form: its fields in rows, by their names in visit_fields.h.
struct FormSection {
  const char* id;
  std::vector<std::vector<std::string_view>> rows;
};
/// All fields of a visit, each once, in the order of the form.
[[nodiscard]] const std::vector<FormSection>& formSections();

[[nodiscard]] QString sectionWord(const QString& id);
/// "Amount of fluid" of exudate_amount.
[[nodiscard]] QString fieldWord(const QString& name);
/// "Little" of light; the field decides, as words return with other meanings.
[[nodiscard]] QString choiceWord(const QString& name, const QString& word);
/// "cm", "mmHg"; empty: without a unit.
[[nodiscard]] QString unitWord(const QString& name);
/// A value as it is said: "moderate", "12 mm", "8.1 %".
[[nodiscard]] QString valueWord(const QString& name, const nlohmann::json& value);
/// Signs of infection, probe to bone, pain: found anew each time, so the last visit's value is
/// shown but never taken over.
[[nodiscard]] bool isAskedAnew(std::string_view name);

}  // namespace tarsus
