#pragma once

#include "app/cli/command.h"
#include "measurement/wound/wound_files.h"
#include "reconstruction/capture/simulator/simulator.h"

#include <filesystem>
#include <vector>

namespace tarsus {

/// What the demonstration found at one visit.
struct DemoVisit {
  WoundFiles files;
  int weeks = 0;  ///< after the first
};

/// Files the visits of an invented patient in records of their own (OUT/demo_records), signs them,
/// and prints the last one's report with its history and comparison (OUT/report_history.pdf).
/// @return comparison.json's members, and what was written
[[nodiscard]] Expected<nlohmann::json> demoHistory(const std::filesystem::path& out,
                                                   FootCase foot,
                                                   const std::vector<DemoVisit>& visits,
                                                   const Job& job);

}  // namespace tarsus
