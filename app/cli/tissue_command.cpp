#include "app/cli/command.h"
#include "app/cli/print.h"
#include "app/version.h"
#include "measurement/outline/outline.h"
#include "measurement/wound/tissue_color.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/ply.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

namespace tarsus {
namespace {

struct Arguments {
  std::filesystem::path model;
  std::filesystem::path tissue;
  std::filesystem::path outline;
};

/// Proposes, writes the file and returns the shares.
Expected<TissueShares> proposeFile(const Arguments& arguments) {
  const auto foot = readPly(arguments.model);
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  const auto file = readOutlineFile(arguments.outline);
  if (!file) {
    return tl::unexpected(file.error());
  }
  const auto outline = outlineOn(*foot, MeshIndex(foot->mesh), *file);
  if (!outline) {
    return tl::unexpected(outline.error());
  }
  const auto bed = openTissueBed(*foot, *outline);
  if (!bed) {
    return tl::unexpected(bed.error());
  }
  const auto map = proposeTissue(*foot, *bed);
  if (!map) {
    return tl::unexpected(map.error());
  }
  if (auto written = writeTissue(arguments.tissue, *map); !written) {
    return tl::unexpected(written.error());
  }
  return sharesOf(*bed, *map);
}

}  // namespace

void addTissue(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      addCommand(app, command, "tissue", "Propose the tissue of a wound bed by its colours");
  sub->add_option("MODEL", arguments->model, "model.ply, mm")->required();
  sub->add_option("OUT", arguments->tissue, "The proposal to write, for measure --tissue")
      ->required()
      ->type_name("OUT.json");
  sub->add_option("--outline", arguments->outline, "Wound outline (JSON, scan frame, mm)")
      ->required()
      ->type_name("FILE");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) -> Expected<nlohmann::json> {
      const auto shares = proposeFile(*arguments);
      if (!shares) {
        return tl::unexpected(shares.error());
      }
      if (!command.quiet && command.json_file != "-") {
        printTissue(*shares);
        std::cout << "Wrote " << arguments->tissue.string()
                  << "; look at it before you use a number.\n";
      }
      nlohmann::json json = toJson(*shares);
      json["version"] = TARSUS_VERSION;
      return json;
    };
  });
}

}  // namespace tarsus
