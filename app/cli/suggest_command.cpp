#include "app/cli/command.h"
#include "app/version.h"
#include "measurement/wound/outline_suggestion.h"
#include "reconstruction/scene/ply.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

namespace tarsus {
namespace {

struct Arguments {
  std::filesystem::path model;
  std::filesystem::path outline;
  std::vector<double> at_mm;
};

nlohmann::json toJson(const SuggestedOutline& suggested) {
  const SuggestionConfidence& parts = suggested.confidence;
  return {{"source", nameOf(OutlineSource::Suggested)},
          {"method", suggested.method},
          {"points", suggested.points_mm.size()},
          {"area_mm2", suggested.area_mm2},
          {"confidence", parts.overall},
          {"confidence_parts",
           {{"edge_share", parts.edge_share},
            {"bed_share", parts.bed_share},
            {"color_contrast", parts.color_contrast},
            {"color_delta_e", parts.color_delta_e},
            {"depth_mm", parts.depth_mm},
            {"drop_mm", parts.drop_mm},
            {"roundness", parts.roundness}}}};
}

void print(const SuggestedOutline& suggested, const std::filesystem::path& file) {
  const SuggestionConfidence& parts = suggested.confidence;
  std::printf("A suggestion, to be looked at and edited: %s\n", file.c_str());
  std::printf("%.0f mm2 inside, %zu points; confidence %.2f\n",
              suggested.area_mm2,
              suggested.points_mm.size(),
              parts.overall);
  std::printf("clear edge on %.0f %% of the curve, %.0f %% of the inside differs from the skin\n",
              100.0 * parts.edge_share,
              100.0 * parts.bed_share);
  std::printf(
      "across the curve the colour changes by %.0f (CIELAB) and the surface falls %.1f mm\n",
      parts.color_delta_e,
      parts.drop_mm);
}

Expected<nlohmann::json> suggest(const Arguments& arguments, bool printing) {
  if (!std::ranges::all_of(arguments.at_mm, [](double x) { return std::isfinite(x); })) {
    return fail(ErrorCode::BadOption, "--at needs three numbers");
  }
  const auto foot = readPly(arguments.model);
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  const MeshIndex index(foot->mesh);
  const auto suggested = suggestOutline(*foot, index, Eigen::Vector3d(arguments.at_mm.data()));
  if (!suggested) {
    return tl::unexpected(suggested.error());
  }
  if (auto written =
          writeOutlinePoints(arguments.outline, suggested->points_mm, OutlineSource::Suggested);
      !written) {
    return tl::unexpected(written.error());
  }
  if (printing) {
    print(*suggested, arguments.outline);
  }
  nlohmann::json result = toJson(*suggested);
  result["version"] = TARSUS_VERSION;
  result["model_sha256"] = foot->sha256;
  return result;
}

}  // namespace

void addSuggest(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      addCommand(app, command, "suggest", "Propose the outline of a wound from one place in it");
  sub->add_option("MODEL", arguments->model, "model.ply, mm")->required();
  sub->add_option("OUT", arguments->outline, "Outline to write (JSON, scan frame, mm)")->required();
  sub->add_option("--at", arguments->at_mm, "A place in the wound, in the model's own mm")
      ->required()
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) {
      return suggest(*arguments, !command.quiet && command.json_file != "-");
    };
  });
}

}  // namespace tarsus
