#include "app/cli/camera_options.h"
#include "app/cli/checks.h"
#include "app/cli/color_options.h"
#include "app/cli/command.h"
#include "app/cli/print.h"
#include "app/version.h"
#include "reconstruction/capture/openni/oni_file.h"
#include "reconstruction/capture/trajectory_file.h"
#include "reconstruction/pipeline/model_folder.h"
#include "reconstruction/pipeline/reconstruct.h"
#include "reconstruction/pipeline/textured_model.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace tarsus {
namespace {

struct Arguments {
  std::filesystem::path scan;
  std::filesystem::path out;
  std::filesystem::path trajectory;
  std::filesystem::path region;
  CameraArguments camera;
  bool no_texture = false;
  ColorArguments color;
  ScanOptions options;
};

void applyColors(Arguments& arguments) {
  const ColoringOptions options = coloringOf(arguments.color, arguments.options.color);
  arguments.options.color = options.color;
  arguments.options.color_card = options.color_card;
  arguments.options.grey_card = options.grey_card;
}

/// Before the folder is written: stopped here, nothing has changed there.
Expected<void> writeAtlas(const Arguments& arguments, const Reconstruction& r, const Job& job) {
  const auto options = atlasOf(arguments.color, arguments.options.color);
  if (!options || r.keyframes.empty()) {
    return {};
  }
  const auto atlas = writeTexturedModel(arguments.out,
                                        {.mesh = &r.model.mesh,
                                         .colors = r.model.colors,
                                         .camera = &r.camera,
                                         .keyframes = r.keyframes,
                                         .placements = r.placements,
                                         .gains = r.gains},
                                        *options,
                                        job);
  return atlas ? Expected<void>() : tl::unexpected(atlas.error());
}

Expected<nlohmann::json> reconstruct(Arguments arguments, bool print, const Job& job) {
  arguments.options.texture = !arguments.no_texture;
  applyColors(arguments);
  if (!arguments.trajectory.empty()) {
    auto trajectory = readTrajectory(arguments.trajectory);
    if (!trajectory) {
      return tl::unexpected(trajectory.error());
    }
    arguments.options.trajectory = std::move(*trajectory);
  }
  if (!arguments.region.empty()) {
    auto region = readRegion(arguments.region);
    if (!region) {
      return tl::unexpected(region.error());
    }
    arguments.options.region = *region;
  }
  const CameraOverrides overrides = overridesOf(arguments.camera);
  const ScanOpener open = [&](const FrameContent& content) {
    return openScan(arguments.scan, overrides, content);
  };
  auto reconstruction = reconstructScan(open, arguments.options, job);
  if (!reconstruction) {
    return tl::unexpected(reconstruction.error());
  }
  auto written = writeAtlas(arguments, *reconstruction, job);
  if (written) {
    written = writeModelFolder(arguments.out, *reconstruction, arguments.options, TARSUS_VERSION);
  }
  if (!written) {
    return tl::unexpected(written.error());
  }
  if (print) {
    printReconstruction(*reconstruction, arguments.out);
  }
  return toJson(*reconstruction, arguments.options, TARSUS_VERSION);
}

}  // namespace

void addReconstruct(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      addCommand(app, command, "reconstruct", "Make a coloured 3D model from a recorded scan");
  sub->add_option("SCAN", arguments->scan, "Scan folder, .oni recording, or any TUM RGB-D sequence")
      ->required();
  sub->add_option("OUT_DIR", arguments->out, "Where model.ply and the rest are written")
      ->required();
  sub->add_option("--voxel-mm", arguments->options.surface.voxel_size_mm, "Voxel size")
      ->check(inRange(0.25, 10.0))
      ->capture_default_str();
  sub->add_flag("--no-texture", arguments->no_texture, "Geometry and fused colours only");
  sub->add_flag("--keep-background",
                arguments->options.keep_background,
                "Keep support, table and wall in the model");
  sub->add_option("--trajectory", arguments->trajectory, "Known poses (TUM) instead of tracking")
      ->type_name("FILE");
  sub->add_flag("--refine-trajectory",
                arguments->options.refine_trajectory,
                "Take the known poses as a start and move them until the frames agree")
      ->needs("--trajectory");
  sub->add_option(
         "--region", arguments->region, "Keep only what lies in this box of the scan (JSON)")
      ->type_name("FILE");
  addColorOptions(*sub, "--texture-iterations", arguments->color);
  sub->get_option("--atlas")->excludes("--no-texture");
  addCameraOptions(*sub, arguments->camera);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) {
      return reconstruct(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
