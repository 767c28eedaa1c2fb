#include "app/cli/command.h"
#include "app/cli/progress.h"
#include "app/cli/records/record_commands.h"
#include "app/version.h"
#include "reconstruction/base/atomic_file.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <exception>
#include <iostream>

namespace tarsus {
namespace {

constexpr int kDone = 0;
constexpr int kWorldAtFault = 1;
constexpr int kWrongUsage = 2;
constexpr int kBug = 3;

std::stop_source& stopSource() {
  static std::stop_source source;
  return source;
}

/// Ctrl+C, and whoever ends the program kindly, asks the running stage to stop, so that temporary
/// files are cleaned up.
void stopOnInterrupt() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is told as a full disk
  stopSource();                   // made now: a signal handler must not
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int which) {
      stopSource().request_stop();
      std::signal(which, SIG_DFL);  // the second one ends at once
    });
  }
}

int finish(const Command& command, const nlohmann::json& result, int code) {
  if (command.json_file == "-") {
    std::cout << result.dump(2) << std::endl;
  } else if (!command.json_file.empty()) {
    if (auto written = writeTextAtomically(command.json_file, result.dump(2) + "\n"); !written) {
      std::cerr << "tarsus-cli: " << describe(written.error()) << '\n';
      return kWorldAtFault;
    }
  }
  return code;
}

int run(const Command& command) {
  stopOnInterrupt();
  ProgressBar bar(command.quiet);
  const Job job{
      .stop = stopSource().get_token(),
      .report = [&](std::string_view stage, double fraction) { bar.show(stage, fraction); }};
  try {
    auto result = command.run(job);
    bar.clear();
    if (result) {
      return finish(command, *result, kDone);
    }
    std::cerr << "tarsus-cli: " << describe(result.error()) << '\n';
    return finish(
        command,
        {{"error",
          {{"code", codeName(result.error().code)}, {"message", describe(result.error())}}}},
        kWorldAtFault);
  } catch (const std::exception& exception) {
    bar.clear();
    std::cerr << "tarsus-cli: a fault in the program; please report it: " << exception.what()
              << '\n';
    return finish(command, {{"error", {{"code", "bug"}, {"message", exception.what()}}}}, kBug);
  }
}

int parseAndRun(int argc, char** argv) {
  CLI::App app(
      "Tarsus measures foot ulcers on 3D models made with a depth camera.\n"
      "Research software. Not a medical device; not cleared by any authority; must not be the\n"
      "sole basis of a clinical decision.");
  app.set_version_flag("--version", TARSUS_VERSION);
  app.require_subcommand(1);
  Command command;
  addSimulate(app, command);
  addCalibrate(app, command);
  addDevices(app, command);
  addRecord(app, command);
  addReconstruct(app, command);
  addTexture(app, command);
  addEvaluate(app, command);
  addSuggest(app, command);
  addMeasure(app, command);
  addCompare(app, command);
  addTissue(app, command);
  addScore(app, command);
  addReport(app, command);
  addPhantom(app, command);
  addVerify(app, command);
  addStoreCommands(app, command);
  addPatients(app, command);
  addWounds(app, command);
  addVisits(app, command);
  addDemo(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  for (const CLI::App* sub = &app; !sub->get_subcommands().empty();) {
    sub = sub->get_subcommands().front();
    if (const std::string file = outputThatClashes(*sub); !file.empty()) {
      std::cerr << "tarsus-cli: " << file
                << " is read, or written a second time, by this command and would be overwritten; "
                   "give another output.\n";
      return kWrongUsage;
    }
  }
  return run(command);
}

}  // namespace
}  // namespace tarsus

int main(int argc, char** argv) { return tarsus::parseAndRun(argc, argv); }
