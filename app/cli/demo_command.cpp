#include "app/cli/command.h"
#include "app/cli/demo_history.h"
#include "app/cli/print.h"
#include "app/cli/print_report.h"
#include "app/cli/simulate_options.h"
#include "app/cli/wound_arguments.h"
#include "app/version.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/pipeline/model_folder.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Arguments {
  fs::path out = "demo";
  SimulatorOptions simulation;
};

void say(bool printing, const std::string& text) {
  if (printing) {
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
  }
}

Expected<Reconstruction> reconstructInto(const fs::path& scan,
                                         const fs::path& out,
                                         const Job& job) {
  const ScanOptions options;
  const ScanOpener open = [&](const FrameContent& content) {
    return openScanFolder(scan, {}, content);
  };
  auto reconstruction = reconstructScan(open, options, job);
  if (!reconstruction) {
    return reconstruction;
  }
  if (auto written = writeModelFolder(out, *reconstruction, options, TARSUS_VERSION); !written) {
    return tl::unexpected(written.error());
  }
  return reconstruction;
}

/// Measures the wound number `n` (from 1) with the true outline, as a clinician who outlines
/// perfectly would, and prints the report.
Expected<json> measureWoundNumber(int n, const fs::path& out, const json& truth, bool printing) {
  const fs::path truth_folder = out / "scan" / "truth";
  const std::string number = std::to_string(n);
  const auto point = [&](const char* key) { return truth.at(key).get<std::vector<double>>(); };
  const WoundArguments arguments{.model = out / "model.ply",
                                 .outline = truth_folder / ("outline_" + number + ".json"),
                                 .skin_curve = {},
                                 .heel_mm = point("heel_mm"),
                                 .toe_mm = point("toe_mm")};
  auto measured = measureFiles(arguments);
  if (!measured) {
    return tl::unexpected(measured.error());
  }
  const json& known = truth.at("wounds").at(static_cast<std::size_t>(n - 1));
  const json result = measurementJson(*measured);
  const std::string suffix = n == 1 ? "" : "_" + number;
  auto written =
      writeTextAtomically(out / ("measurement" + suffix + ".json"), result.dump(2) + "\n");
  if (written) {
    written = printReport(
        out / ("report" + suffix + ".pdf"),
        *measured,
        arguments.model,
        {.title = "Simulated patient, wound " + number + ": " + known.value("site", "")});
  }
  if (!written) {
    return tl::unexpected(written.error());
  }
  say(printing, "\nWound " + number + ", " + known.value("site", ""));
  if (printing) {
    printMeasurement(measured->wound.numbers, known);
  }
  return json{{"measurement", result}, {"truth", known}};
}

constexpr int kWeeksLater = 4;

WoundFiles filesOfVisit(const fs::path& out, const json& truth) {
  const auto point = [&](const char* key) {
    const auto p = truth.at(key).get<std::vector<double>>();
    return Eigen::Vector3d(p.at(0), p.at(1), p.at(2));
  };
  return {.model = out / "model.ply",
          .outline = out / "scan" / "truth" / "outline_1.json",
          .skin_curve = {},
          .tissue = {},
          .landmarks = Landmarks{.heel_mm = point("heel_mm"), .toe_mm = point("toe_mm")}};
}

void printHistory(const json& history, const json& before, const json& now) {
  const auto change = [&](const char* key) {
    return 100.0 * (now.at(key).get<double>() / before.at(key).get<double>() - 1.0);
  };
  const auto line = [&](const char* name, const char* key, double truth) {
    const json& value = history.at(key);
    std::printf("  %-8s %s %%   true %+.1f %%\n",
                name,
                value.is_number()
                    ? std::to_string(static_cast<int>(std::lround(value.get<double>()))).c_str()
                    : "not measurable",
                truth);
  };
  std::printf("\nFirst wound, change in %d weeks\n", kWeeksLater);
  line("area", "area_change_percent", change("opening_area_mm2"));
  line("volume", "volume_change_percent", change("volume_mm3"));
  std::printf("  skin laid on skin: %s\n",
              history.value("accepted", false) ? "accepted" : "refused");
}

/// The same foot weeks later, the first wound's history, comparison and report.
Expected<json> secondVisit(const Arguments& arguments,
                           const json& truth,
                           bool printing,
                           const Job& job) {
  const fs::path out = arguments.out / "second_visit";
  const SimulatorOptions later =
      weeksLater(arguments.simulation, HealingCourse::Shrinking, kWeeksLater);
  if (auto done = simulateScan(out / "scan", later, job); !done) {
    return tl::unexpected(done.error());
  }
  if (auto reconstruction = reconstructInto(out / "scan", out, job); !reconstruction) {
    return tl::unexpected(reconstruction.error());
  }
  const auto text = readTextFile(out / "scan" / "truth" / "truth.json");
  if (!text) {
    return tl::unexpected(text.error());
  }
  const json truth_now = json::parse(*text);
  auto history = demoHistory(arguments.out,
                             arguments.simulation.foot,
                             {{.files = filesOfVisit(arguments.out, truth), .weeks = 0},
                              {.files = filesOfVisit(out, truth_now), .weeks = kWeeksLater}},
                             job);
  if (!history) {
    return history;
  }
  if (auto written =
          writeTextAtomically(arguments.out / "comparison.json", history->dump(2) + "\n");
      !written) {
    return tl::unexpected(written.error());
  }
  if (printing) {
    printHistory(*history, truth.at("wounds").at(0), truth_now.at("wounds").at(0));
  }
  return history;
}

Expected<json> demo(const Arguments& arguments, bool printing, const Job& job) {
  const fs::path& out = arguments.out;
  say(printing, "1/4 Scanning a simulated foot ...");
  if (auto done = simulateScan(out / "scan", arguments.simulation, job); !done) {
    return tl::unexpected(done.error());
  }
  say(printing, "2/4 Reconstructing ...");
  auto reconstruction = reconstructInto(out / "scan", out, job);
  if (!reconstruction) {
    return tl::unexpected(reconstruction.error());
  }
  if (printing) {
    printReconstruction(*reconstruction, out);
  }
  say(printing, "3/4 Measuring, with the truth beside ...");
  auto text = readTextFile(out / "scan" / "truth" / "truth.json");
  if (!text) {
    return tl::unexpected(text.error());
  }
  const json truth = json::parse(*text);
  json results = json::array();
  for (std::size_t n = 1; n <= truth.at("wounds").size(); ++n) {
    auto result = measureWoundNumber(static_cast<int>(n), out, truth, printing);
    if (!result) {
      return tl::unexpected(result.error());
    }
    results.push_back(std::move(*result));
  }
  say(printing,
      "\n4/4 The same foot " + std::to_string(kWeeksLater) + " weeks later, and what changed ...");
  auto history = secondVisit(arguments, truth, printing, job);
  if (!history) {
    return tl::unexpected(history.error());
  }
  say(printing,
      "\nOpen " + (out / "report_history.pdf").string() + " and " + (out / "model.ply").string());
  return json{{"wounds", results}, {"history", *history}, {"out", out.string()}};
}

}  // namespace

void addDemo(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      addCommand(app,
                 command,
                 "demo",
                 "The whole job without hardware: scan, reconstruct, measure, compare, report");
  sub->add_option("OUT", arguments->out, "Where everything is written")->capture_default_str();
  addSimulationOptions(*sub, arguments->simulation);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) {
      return demo(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
