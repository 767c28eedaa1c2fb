#include "app/cli/records/visit_fields_option.h"

#include "reconstruction/base/atomic_file.h"

#include <CLI/CLI.hpp>

namespace tarsus {

using nlohmann::json;

void addFieldsOptions(CLI::App& sub, FieldsOption& option) {
  sub.add_option("--fields", option.file, "Fields of the form by their names (JSON)")
      ->type_name("FILE");
  sub.add_option("--set", option.set, "One field; may be repeated")->type_name("NAME=VALUE");
  sub.add_option("--unset", option.unset, "A field that is not known after all")->type_name("NAME");
}

Expected<void> takeFields(const FieldsOption& option, json& fields) {
  if (!option.file.empty()) {
    const auto text = readTextFile(option.file);
    if (!text) {
      return tl::unexpected(text.error());
    }
    const json given = json::parse(*text, nullptr, false);
    if (!given.is_object()) {
      return fail(ErrorCode::BadOption,
                  option.file.string() + R"( must be JSON such as {"abi": 0.9, "edge": "flat"})");
    }
    fields.update(given);
  }
  for (const std::string& assignment : option.set) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      return fail(ErrorCode::BadOption, "--set takes NAME=VALUE, not \"" + assignment + "\"");
    }
    const std::string value = assignment.substr(equals + 1);
    const json parsed = json::parse(value, nullptr, false);
    fields[assignment.substr(0, equals)] = parsed.is_discarded() ? json(value) : parsed;
  }
  for (const std::string& name : option.unset) {
    fields.erase(name);
  }
  return {};
}

}  // namespace tarsus
