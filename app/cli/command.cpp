#include "app/cli/command.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <vector>

namespace tarsus {

CLI::App* addCommand(CLI::App& app, Command& command, const char* name, const char* what) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->add_option("--json", command.json_file, "Write the machine-readable result (- for stdout)")
      ->type_name("FILE");
  sub->add_flag("--quiet", command.quiet, "No progress bar and no text on stdout");
  return sub;
}

namespace {

namespace fs = std::filesystem;

/// What a command writes into a folder that it is given.
std::vector<std::string> filesOf(const std::string& option, const std::string& value) {
  if (option != "--artifacts") {
    return {value};
  }
  std::vector<std::string> files;
  for (const char* name : {"bed.ply", "reference.ply", "depth_map.png", "section.csv"}) {
    files.push_back((fs::path(value) / name).string());
  }
  return files;
}

}  // namespace

std::string outputThatClashes(const CLI::App& sub) {
  const std::set<std::string> outputs{
      "--json", "OUT", "OUT_DIR", "--heatmap", "--artifacts", "--chart", "--map"};
  std::vector<std::string> written;
  std::vector<std::string> read;
  for (const CLI::Option* option : sub.get_options()) {
    for (const std::string& value : option->results()) {
      if (outputs.contains(option->get_name())) {
        std::ranges::copy(filesOf(option->get_name(), value), std::back_inserter(written));
      } else {
        read.push_back(value);
      }
    }
  }
  std::error_code no_such_file;
  std::set<fs::path> places;
  for (const std::string& output : written) {
    if (output != "-" && !places.insert(fs::weakly_canonical(output, no_such_file)).second) {
      return output;
    }
  }
  for (const std::string& output : written) {
    for (const std::string& input : read) {
      if (fs::equivalent(output, input, no_such_file)) {
        return output;
      }
    }
  }
  return {};
}

}  // namespace tarsus
