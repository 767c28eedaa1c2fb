#include "app/cli/command.h"
#include "app/cli/print.h"
#include "app/cli/wound_arguments.h"
#include "measurement/report/close_view.h"
#include "measurement/wound/section.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/scene/ply.h"

#include <CLI/CLI.hpp>

#include <array>
#include <memory>
#include <vector>

namespace tarsus {
namespace {

/// The bed with its depths; under a second name too, as the only one that MeshLab shows.
Expected<void> writeBed(const std::filesystem::path& path, const MeasuredModel& measured) {
  TexturedMesh bed;
  bed.mesh = measured.wound.bed;
  bed.colors = measured.wound.bed_colors;
  if (!measured.foot.unseen.empty()) {
    for (const float share : measured.wound.bed_unseen) {
      bed.unseen.push_back(share >= 0.5F ? 1 : 0);
    }
  }
  const std::vector<VertexField> depths{{"depth_mm", measured.wound.bed_depth_mm},
                                        {"quality", measured.wound.bed_depth_mm}};
  return writePly(path, bed, depths);
}

/// section.csv along the given line, or along the wound's greatest chord and a little beyond.
Expected<void> writeSectionOf(const std::filesystem::path& path,
                              const std::vector<double>& line_mm,
                              MeasuredModel& measured) {
  constexpr double kBeyondOutline_mm = 8.0;
  const bool given = line_mm.size() == 6;
  const auto ends =
      given ? std::array{Eigen::Vector3d(line_mm.data()), Eigen::Vector3d(line_mm.data() + 3)}
            : longestChord(measured.wound.outline_mm);
  const auto section = cutSection(measured.foot.mesh,
                                  measured.wound,
                                  ends[0],
                                  ends[1],
                                  {.beyond_mm = given ? 0.0 : kBeyondOutline_mm});
  Warnings& warnings = measured.wound.numbers.warnings;
  if (!section && !given) {  // nobody asked for it: no reason to hold back the measurement
    warnings.push_back({"section_missing", "No section was written: " + section.error().detail});
    return {};
  }
  if (!section) {
    return tl::unexpected(section.error());
  }
  warnings.insert(warnings.end(), section->warnings.begin(), section->warnings.end());
  return writeSection(path, *section);
}

Expected<void> writeArtifacts(const std::filesystem::path& folder,
                              const std::vector<double>& section_line_mm,
                              MeasuredModel& measured) {
  auto written = writeSectionOf(folder / "section.csv", section_line_mm, measured);
  if (written) {
    written = writeBed(folder / "bed.ply", measured);
  }
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
    std::vector<double> section_line_mm;  ///< both ends, or empty
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(app, command, "measure", "Measure one wound on a model");
  addWoundOptions(*sub, arguments->wound);
  auto* artifacts =
      sub->add_option("--artifacts",
                      arguments->artifacts,
                      "Write bed.ply, reference.ply, depth_map.png and section.csv here")
          ->type_name("DIR");
  sub->add_option("--section",
                  arguments->section_line_mm,
                  "Ends of the line of section.csv; default the greatest chord of the outline")
      ->delimiter(',')
      ->expected(6)
      ->type_name("AX,AY,AZ,BX,BY,BZ")
      ->needs(artifacts);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) -> Expected<nlohmann::json> {
      auto measured = measureFiles(arguments->wound);
      if (!measured) {
        return tl::unexpected(measured.error());
      }
      if (!arguments->artifacts.empty()) {
        if (auto written =
                writeArtifacts(arguments->artifacts, arguments->section_line_mm, *measured);
            !written) {
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
