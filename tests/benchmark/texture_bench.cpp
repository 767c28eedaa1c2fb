// How good and how quick the texture stage is, judged by views that it was not given:
//   tarsus-bench-texture foot SCAN MODEL [--work DIR] [--pictures DIR] [--json FILE]
//     SCAN as `tarsus-cli simulate` writes it, MODEL as `tarsus-cli reconstruct --no-texture` does.
//     Poses as tracked ("good"), and each made wrong by 2 mm and 0.5 degree about the camera's own
//     centre ("off"; --about-target turns about what the camera looks at instead).
//   tarsus-bench-texture bust SCAN [the same options]
//     Real views with known poses; only the sensed pictures can judge.
//   tarsus-bench-texture evaluate SCAN MODEL COLORED.ply... judges models that others coloured
// --work leaves the same task for open3d_color_map.py; --json takes the figures for
// texture_table.py.

#include "reconstruction/scene/ply.h"
#include "tests/benchmark/bench_support.h"
#include "tests/benchmark/texture_export.h"
#include "tests/benchmark/texture_runs.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace tarsus;  // NOLINT: a program of its own

struct Options {
  std::filesystem::path scan;
  std::filesystem::path model;
  std::vector<std::filesystem::path> colored;
  std::filesystem::path work;
  std::filesystem::path pictures;
  std::filesystem::path json;
  double voxel_size_mm = 1.0;
  PoseError error;
};

void printHead() {
  std::printf("%-24s %8s %9s %6s | %-34s | %-26s | %6s\n",
              "",
              "",
              "",
              "photo",
              "PSNR [dB]: noise-free",
              "sharpness: Laplacian",
              "seen,");
  std::printf("%-24s %8s %9s %6s | %10s %12s %10s | %8s %8s %8s | %6s\n",
              "poses, colours",
              "seconds",
              "vertices",
              "RMSE",
              "mean",
              "least",
              "sensed",
              "/ clean",
              "grad.",
              "/ source",
              "black");
}

/// A figure that is not known shows as a dash.
std::string cell(double value, int digits) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return value == 0.0 ? "-" : text.data();
}

std::string nameOf(const TextureRun& run) { return run.poses + ", " + run.method; }

class Report {
 public:
  Report(const TextureScan& scan, std::vector<LeftOutView> views, const Options& options)
      : color_(scan.camera.color), views_(std::move(views)), options_(options) {
    std::printf("%zu keyframes, %zu views left out (frames", scan.keyframes.size(), views_.size());
    for (const Keyframe& frame : scan.left_out) {
      std::printf(" %d", frame.frame.index);
    }
    std::printf(")\n");
    printHead();
  }

  void add(const TextureRun& run) {
    const std::filesystem::path pictures = options_.pictures.empty()
                                               ? std::filesystem::path()
                                               : options_.pictures / (run.poses + "_" + run.method);
    const TextureFigures f = judge(run.model, color_, views_, pictures);
    const int black = seenWithoutColor(run.model);
    std::printf("%-24s %8s %9zu %6s | %10s %12s %10s | %8s %8s %8s | %6d\n",
                nameOf(run).c_str(),
                cell(run.seconds, 2).c_str(),
                run.model.mesh.vertices.size(),
                cell(run.photometric_rmse.value_or(0.0), 2).c_str(),
                cell(f.psnr_clean_db, 2).c_str(),
                cell(f.least_psnr_clean_db, 2).c_str(),
                cell(f.psnr_sensed_db, 2).c_str(),
                cell(f.laplacian_to_clean, 3).c_str(),
                cell(f.gradient_to_clean, 3).c_str(),
                cell(f.gradient_to_sensed, 3).c_str(),
                black);
    std::fflush(stdout);
    rows_.push_back({{"poses", run.poses},
                     {"method", run.method},
                     {"seconds", run.seconds},
                     {"vertices", run.model.mesh.vertices.size()},
                     {"photometric_rmse", run.photometric_rmse.value_or(0.0)},
                     {"psnr_clean_db", f.psnr_clean_db},
                     {"least_psnr_clean_db", f.least_psnr_clean_db},
                     {"psnr_sensed_db", f.psnr_sensed_db},
                     {"laplacian_to_clean", f.laplacian_to_clean},
                     {"gradient_to_clean", f.gradient_to_clean},
                     {"gradient_to_sensed", f.gradient_to_sensed},
                     {"seen_without_color", black}});
    for (const auto& [name, value] : run.further) {
      rows_.back()[name] = value;
    }
  }

  void write() const {
    if (!options_.json.empty()) {
      std::ofstream(options_.json) << rows_.dump(1) << '\n';
    }
  }

 private:
  Intrinsics color_;
  std::vector<LeftOutView> views_;
  const Options& options_;
  nlohmann::json rows_ = nlohmann::json::array();
};

/// Plain, averaged and aligned, with good poses and with wrong ones.
/// @param foot  the true one, or null
void runAll(const TextureScan& scan,
            const TexturedMesh* foot,
            Report& report,
            const Options& options) {
  std::optional<TextureRun> ceiling;
  for (const std::string poses : {"good", "off"}) {
    const std::vector<Keyframe> keyframes =
        poses == "good" ? scan.keyframes : withWrongPoses(scan.keyframes, options.error);
    TextureRun plain = plainRun(scan, keyframes);
    plain.poses = poses;
    report.add(plain);
    for (const bool align : {false, true}) {
      TextureRun run = runStage(scan, keyframes, align);
      run.poses = poses;
      run.further.emplace("observations", countObservations(run.model, scan.camera, keyframes));
      report.add(run);
      if (!align && !options.work.empty()) {
        exportTask(options.work / poses, run.model, scan.camera, keyframes);
      }
      if (!align && foot != nullptr && poses == "good") {
        ceiling = trueColors(run.model, *foot);
      }
    }
  }
  if (ceiling) {
    report.add(*ceiling);
  }
}

void benchFoot(const Options& options) {
  const TextureScan scan = loadFoot(options.scan, options.model);
  const TrueScene truth = loadTrueScene(options.scan);
  Report report(scan, leftOutViews(scan, &truth), options);
  runAll(scan, &truth.scene->foot, report, options);
  report.write();
}

void benchBust(const Options& options) {
  const TextureScan scan = loadBust(options.scan, options.voxel_size_mm);
  Report report(scan, leftOutViews(scan, nullptr), options);
  runAll(scan, nullptr, report, options);
  report.write();
}

/// Models that another program coloured: DIR/good/open3d_rigid.ply and the like.
void evaluate(const Options& options) {
  const TextureScan scan = loadFoot(options.scan, options.model);
  const TrueScene truth = loadTrueScene(options.scan);
  Report report(scan, leftOutViews(scan, &truth), options);
  for (const std::filesystem::path& path : options.colored) {
    TextureRun run;
    run.poses = path.parent_path().filename().string();
    run.method = path.stem().string();
    run.model = orExit(readPly(path));
    report.add(run);
  }
  report.write();
}

void addOptions(CLI::App& command, Options& options) {
  command.add_option("--work", options.work, "leave the task for Open3D there");
  command.add_option("--pictures", options.pictures, "rendered, noise-free, sensed side by side");
  command.add_option("--json", options.json, "write the figures there");
  command.add_option("--shift-mm", options.error.shift_mm);
  command.add_option("--turn-deg", options.error.turn_deg);
  command.add_option("--seed", options.error.seed, "of the wrong poses");
  command.add_flag("--about-target", options.error.about_target, "turn about what is looked at");
  command.add_option("--voxel-mm", options.voxel_size_mm, "of the bust's surface");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Judges the texture stage by views left out");
  app.require_subcommand(1);
  Options options;
  CLI::App* const foot = app.add_subcommand("foot", "a simulated scan and its model");
  CLI::App* const bust = app.add_subcommand("bust", "real views with known poses");
  CLI::App* const other = app.add_subcommand("evaluate", "models that others coloured");
  for (CLI::App* const command : {foot, bust, other}) {
    command->add_option("scan", options.scan)->required();
    addOptions(*command, options);
  }
  foot->add_option("model", options.model)->required();
  other->add_option("model", options.model)->required();
  other->add_option("colored", options.colored)->required();
  CLI11_PARSE(app, argc, argv);
  if (!options.pictures.empty()) {
    std::filesystem::create_directories(options.pictures);
  }
  if (foot->parsed()) {
    benchFoot(options);
  } else if (bust->parsed()) {
    benchBust(options);
  } else {
    evaluate(options);
  }
  return 0;
}
