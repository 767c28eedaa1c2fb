#pragma once

#include "app/cli/command.h"
#include "reconstruction/base/error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tarsus {

/// The fields of a visit's form as they are given on the command line.
struct FieldsOption {
  std::filesystem::path file;      ///< JSON, the fields by their names
  std::vector<std::string> set;    ///< name=value
  std::vector<std::string> unset;  ///< names
};

/// --fields, --set, --unset.
void addFieldsOptions(CLI::App& sub, FieldsOption& option);

/// Writes what was given over `fields`; what it may be is checked where the visit is kept.
/// @errors FileMissing, BadOption
[[nodiscard]] Expected<void> takeFields(const FieldsOption& option, nlohmann::json& fields);

}  // namespace tarsus
