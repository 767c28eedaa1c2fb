#include "app/cli/command.h"

#include <CLI/CLI.hpp>

#include <filesystem>
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

std::string outputThatIsInput(const CLI::App& sub) {
  const std::set<std::string> outputs{
      "--json", "OUT", "OUT_DIR", "--heatmap", "--artifacts", "--chart"};
  std::vector<std::string> written;
  std::vector<std::string> read;
  for (const CLI::Option* option : sub.get_options()) {
    auto& files = outputs.contains(option->get_name()) ? written : read;
    for (const std::string& value : option->results()) {
      files.push_back(value);
    }
  }
  std::error_code no_such_file;
  for (const std::string& output : written) {
    for (const std::string& input : read) {
      if (std::filesystem::equivalent(output, input, no_such_file)) {
        return output;
      }
    }
  }
  return {};
}

}  // namespace tarsus
