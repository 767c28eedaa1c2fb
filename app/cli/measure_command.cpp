#include "app/cli/command.h"
#include "app/cli/print.h"
#include "app/cli/wound_arguments.h"
#include "measurement/report/close_view.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/scene/ply.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace tarsus {
namespace {

Expected<void> writeArtifacts(const std::filesystem::path& folder, const MeasuredModel& measured) {
  TexturedMesh bed;
  bed.mesh = measured.wound.bed;
  bed.colors = measured.wound.bed_colors;
  auto written = writePly(folder / "bed.ply", bed);
  if (written) {
    TexturedMesh reference;
    reference.mesh = measured.wound.reference;
    written = writePly(folder / "reference.ply", reference);
  }
  if (written) {
    const ReportContent pictures = illustrate(measured.foot, measured.wound, measured.landmarks);
    written = writeColorImage(folder / "depth_map.png", pictures.depth_map);
  }
  return written;
}

}  // namespace

void addMeasure(CLI::App& app, Command& command) {
  struct Arguments {
    WoundArguments wound;
    std::filesystem::path artifacts;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(app, command, "measure", "Measure one wound on a model");
  addWoundOptions(*sub, arguments->wound);
  sub->add_option(
         "--artifacts", arguments->artifacts, "Write bed.ply, reference.ply and depth_map.png here")
      ->type_name("DIR");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) -> Expected<nlohmann::json> {
      auto measured = measureFiles(arguments->wound);
      if (!measured) {
        return tl::unexpected(measured.error());
      }
      if (!arguments->artifacts.empty()) {
        if (auto written = writeArtifacts(arguments->artifacts, *measured); !written) {
          return tl::unexpected(written.error());
        }
      }
      if (!command.quiet && command.json_file != "-") {
        printMeasurement(measured->wound.numbers, nullptr);
        if (measured->tissue) {
          printTissue(*measured->tissue);
        }
      }
      return measurementJson(*measured);
    };
  });
}

}  // namespace tarsus
