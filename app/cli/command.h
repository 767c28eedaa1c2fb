#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): not ours
class App;
}

namespace tarsus {

/// What the command line asks for: filled in while parsing, run afterwards.
struct Command {
  std::function<Expected<nlohmann::json>(const Job&)> run;
  std::string json_file;  ///< "-": stdout; empty: no machine-readable result
  bool quiet = false;
};

/// A subcommand with the options that all have (--json, --quiet).
CLI::App* addCommand(CLI::App& app, Command& command, const char* name, const char* what);

/// The output of a parsed subcommand that is one of its own inputs or another output, or empty:
/// writing it would destroy the other.
[[nodiscard]] std::string outputThatClashes(const CLI::App& sub);

void addSimulate(CLI::App& app, Command& command);
/// ISO 8601, from the clock.
[[nodiscard]] std::string todayUtc();

void addCalibrate(CLI::App& app, Command& command);
void addDevices(CLI::App& app, Command& command);
void addRecord(CLI::App& app, Command& command);
void addReconstruct(CLI::App& app, Command& command);
void addTexture(CLI::App& app, Command& command);
void addEvaluate(CLI::App& app, Command& command);
void addSuggest(CLI::App& app, Command& command);
void addMeasure(CLI::App& app, Command& command);
void addCompare(CLI::App& app, Command& command);
void addTissue(CLI::App& app, Command& command);
void addScore(CLI::App& app, Command& command);
void addReport(CLI::App& app, Command& command);
void addPhantom(CLI::App& app, Command& command);
void addVerify(CLI::App& app, Command& command);
void addDemo(CLI::App& app, Command& command);

}  // namespace tarsus
