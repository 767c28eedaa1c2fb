#include "app/cli/color_options.h"
#include "app/cli/command.h"
#include "app/cli/print.h"
#include "app/version.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/pipeline/recolor_folder.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace tarsus {
namespace {

struct Arguments {
  std::filesystem::path folder;
  ColorArguments color;
  std::vector<double> focus_mm;
};

Expected<nlohmann::json> texture(const Arguments& arguments, bool printing, const Job& job) {
  ColorMapOptions color;
  if (arguments.focus_mm.size() == 3) {
    if (!std::ranges::all_of(arguments.focus_mm, [](double x) { return std::isfinite(x); })) {
      return fail(ErrorCode::BadOption, "--focus needs a point of the model, in mm");
    }
    color.focus = ColorFocus{.center_mm = Eigen::Vector3d(arguments.focus_mm.data())};
  }
  RecoloringOptions options{.coloring = coloringOf(arguments.color, color), .atlas = {}};
  options.atlas = atlasOf(arguments.color, options.coloring.color);
  const auto recoloring = recolorModelFolder(arguments.folder, options, TARSUS_VERSION, job);
  if (!recoloring) {
    return tl::unexpected(recoloring.error());
  }
  if (printing) {
    printRecoloring(*recoloring, arguments.folder);
  }
  const auto record = readTextFile(arguments.folder / "reconstruction.json");
  if (!record) {
    return tl::unexpected(record.error());
  }
  return nlohmann::json::parse(*record);
}

}  // namespace

void addTexture(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(app,
                             command,
                             "texture",
                             "Colour a model anew from its keyframes; Ctrl-C ends the alignment of "
                             "the pictures and keeps what it has reached");
  sub->add_option("MODEL_DIR", arguments->folder, "What reconstruct wrote: model.ply, keyframes/")
      ->required();
  addColorOptions(*sub, "--iterations", arguments->color);
  sub->add_option("--focus",
                  arguments->focus_mm,
                  "Finest colours within 60 mm of this place of the model, coarser elsewhere")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) {
      return texture(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
