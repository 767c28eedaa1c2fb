#include "app/cli/command.h"

#include <CLI/CLI.hpp>

namespace tarsus {

CLI::App* addCommand(CLI::App& app, Command& command, const char* name, const char* what) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->add_option("--json", command.json_file, "Write the machine-readable result (- for stdout)")
      ->type_name("FILE");
  sub->add_flag("--quiet", command.quiet, "No progress bar and no text on stdout");
  return sub;
}

}  // namespace tarsus
