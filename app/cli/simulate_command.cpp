#include "app/cli/checks.h"
#include "app/cli/simulate_options.h"
#include "reconstruction/capture/openni/oni_file.h"
#include "reconstruction/capture/simulator/simulator.h"

#include <CLI/CLI.hpp>

#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <string>

namespace tarsus {
namespace {

/// For `simulate` alone: the demonstration shows a scan as it should be.
void addFaultOption(CLI::App& sub, SimulatorOptions& options) {
  constexpr std::array kFaults{ScanFault::None,
                               ScanFault::Black,
                               ScanFault::Jump,
                               ScanFault::Holes,
                               ScanFault::Dropped,
                               ScanFault::Mirrored,
                               ScanFault::Rest,
                               ScanFault::Blocked,
                               ScanFault::Unit};
  std::map<std::string, ScanFault> faults;
  for (const ScanFault fault : kFaults) {
    faults.emplace(nameOf(fault), fault);
  }
  sub.add_option("--fault",
                 options.fault,
                 "What goes wrong: none; black (15 empty frames), jump (3 steps of 20 mm aside), "
                 "holes (30 % of the depth missing), dropped (every second frame missing), "
                 "mirrored (colour, second half), rest (no motion), blocked (a hand before the "
                 "camera for 1 s) or unit (0.125 mm called 1 mm)")
      ->transform(CLI::CheckedTransformer(faults).description(""))
      ->type_name("NAME");
}

}  // namespace

void addSimulationOptions(CLI::App& sub, SimulatorOptions& options) {
  const std::map<std::string, FootCase> feet{{"forefoot", FootCase::Forefoot},
                                             {"heel", FootCase::Heel},
                                             {"lateral", FootCase::Lateral},
                                             {"two", FootCase::Two}};
  const std::map<std::string, CameraPath> paths{
      {"rig", CameraPath::Rig}, {"loop", CameraPath::Loop}, {"quick", CameraPath::Quick}};
  const std::map<std::string, CameraLayout> layouts{{"aligned", CameraLayout::Aligned},
                                                    {"offset", CameraLayout::Offset}};
  sub.add_option("--foot", options.foot, "Which ulcers: forefoot, heel, lateral or two")
      ->transform(CLI::CheckedTransformer(feet).description(""))
      ->type_name("CASE");
  sub.add_option("--frames", options.frames, "Frames over the 20 s motion")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  sub.add_option("--seed", options.seed, "Of the noise")->capture_default_str();
  sub.add_option("--noise", options.noise, "0: none, 1: as a structured-light camera")
      ->check(inRange(0.0, 10.0))
      ->capture_default_str();
  sub.add_option("--jitter-mm", options.jitter_mm, "Hand shake, standard deviation")
      ->check(inRange(0.0, 20.0))
      ->capture_default_str();
  sub.add_option("--camera", options.layout, "Colour camera: aligned with depth, or offset")
      ->transform(CLI::CheckedTransformer(layouts).description(""))
      ->type_name("LAYOUT");
  sub.add_option("--path", options.path, "Camera motion: rig, loop or quick")
      ->transform(CLI::CheckedTransformer(paths).description(""))
      ->type_name("PATH");
  sub.add_option("--mesh", options.mesh, "A closed foot mesh (OBJ) instead of the built-in foot")
      ->type_name("FILE.obj");
}

/// For `simulate` alone: the demonstration shows a foot.
void addObjectOption(CLI::App& sub, SimulatorOptions& options) {
  sub.add_option("--object",
                 options.object,
                 "Instead of a foot: this object as it is, on a table (STL, PLY or OBJ, mm, z up); "
                 "see the command phantom")
      ->type_name("FILE")
      ->excludes("--mesh")
      ->excludes("--foot");
}

namespace {

/// For `simulate` alone: the same foot at another visit.
struct LaterVisit {
  std::string course;
  int weeks = 0;
};

void addVisitOptions(CLI::App& sub, SimulatorOptions& options, LaterVisit& visit) {
  auto* course = sub.add_option("--healing",
                                visit.course,
                                "The same foot at a later visit: its ulcers are shrinking, "
                                "deepening, filling or splitting")
                     ->check(CLI::IsMember({"shrinking", "deepening", "filling", "splitting"}))
                     ->type_name("COURSE");
  sub.add_option("--week", visit.weeks, "How many weeks after the first visit")
      ->check(CLI::Range(0, 52))
      ->needs(course);
  sub.add_option("--area-factor", options.area_factor, "Openings against the first visit")
      ->check(inRange(0.01, 4.0))
      ->excludes(course);
  sub.add_option("--depth-factor", options.depth_factor, "Depths against the first visit")
      ->check(inRange(0.01, 4.0))
      ->excludes(course);
  sub.add_flag("--split", options.split, "Each ulcer healed across into two")->excludes(course);
  sub.add_option("--posed",
                 options.posed,
                 "Foot, toes, camera and light otherwise, by this number; 0: as at first")
      ->excludes(course);
}

/// Turns the frames of a scan folder into scan.oni in it; truth/ stays.
Expected<void> intoRecording(const std::filesystem::path& folder, const Job& job) {
  if (auto written = writeOniRecording(folder, folder / "scan.oni", job); !written) {
    return written;
  }
  std::error_code ignored;
  for (const char* part :
       {"rgb", "depth", "rgb.txt", "depth.txt", "associations.txt", "camera.json"}) {
    std::filesystem::remove_all(folder / part, ignored);
  }
  return {};
}

}  // namespace

void addSimulate(CLI::App& app, Command& command) {
  struct Arguments {
    std::filesystem::path out;
    SimulatorOptions options;
    std::string format = "folder";
    LaterVisit visit;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      app, command, "simulate", "Make the scan of a computer-made foot with ulcers of known size");
  sub->add_option("OUT", arguments->out, "Scan folder to write, with truth/ in it")->required();
  addSimulationOptions(*sub, arguments->options);
  sub->add_option("--format", arguments->format, "Frames as a scan folder, or as scan.oni in it")
      ->check(CLI::IsMember({"folder", "oni"}))
      ->capture_default_str();
  addVisitOptions(*sub, arguments->options, arguments->visit);
  addFaultOption(*sub, arguments->options);
  addObjectOption(*sub, arguments->options);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) -> Expected<nlohmann::json> {
      const auto course = healingCourseNamed(arguments->visit.course);
      const SimulatorOptions options =
          course ? weeksLater(arguments->options, *course, arguments->visit.weeks)
                 : arguments->options;
      if (auto done = simulateScan(arguments->out, options, job); !done) {
        return tl::unexpected(done.error());
      }
      if (arguments->format == "oni") {
        if (auto turned = intoRecording(arguments->out, job); !turned) {
          return tl::unexpected(turned.error());
        }
      }
      if (!command.quiet && command.json_file != "-") {
        std::cout << "Wrote the scan to " << arguments->out.string()
                  << "; what is true of it is in truth/.\n";
      }
      return nlohmann::json{{"scan", arguments->out.string()},
                            {"frames", options.frames},
                            {"seed", options.seed},
                            {"fault", nameOf(options.fault)}};
    };
  });
}

}  // namespace tarsus
