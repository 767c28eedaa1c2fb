#pragma once

#include "app/cli/command.h"
#include "measurement/wound/wound_files.h"

#include <filesystem>
#include <vector>

namespace tarsus {

/// What `measure`, `report` and `demo` need to know of one wound.
struct WoundArguments {
  std::filesystem::path model;
  std::filesystem::path outline;
  std::filesystem::path skin_curve;  ///< empty: offset of the outline
  std::filesystem::path tissue;      ///< empty: none
  std::vector<double> heel_mm;       ///< 3 coordinates, or empty
  std::vector<double> toe_mm;
};

void addWoundOptions(CLI::App& sub, WoundArguments& arguments);

[[nodiscard]] WoundFiles filesOf(const WoundArguments& arguments);

/// Reads model, curves and paint, and measures.
/// @errors those of the other measureFiles
[[nodiscard]] Expected<MeasuredModel> measureFiles(const WoundArguments& arguments);

/// measurement.json: the numbers with tissue, version and warnings.
[[nodiscard]] nlohmann::json measurementJson(const MeasuredModel& measured);

}  // namespace tarsus
