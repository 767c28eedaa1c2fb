#include "app/cli/camera_options.h"
#include "app/cli/command.h"
#include "app/cli/print_verification.h"
#include "app/version.h"
#include "measurement/phantom/control_chart.h"
#include "measurement/phantom/verify.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/scan_folder.h"
#include "reconstruction/pipeline/reconstruct.h"
#include "reconstruction/scene/ply.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path scan;
  fs::path phantom;
  fs::path chart;
  CameraArguments camera;
};

/// The model to be verified, and what is known of the camera behind it.
struct Scanned {
  TexturedMesh model;
  Warnings refusal_reasons;  ///< of the scan
  std::string camera_model;
  std::string camera_serial;
  std::optional<double> seconds_since_power_on;
};

/// As a foot is reconstructed; colours are not needed.
Expected<Scanned> reconstructed(const Arguments& arguments, const Job& job) {
  const CameraOverrides overrides = overridesOf(arguments.camera);
  const ScanOpener open = [&](const FrameContent& content) {
    return openScanFolder(arguments.scan, overrides, content);
  };
  ScanOptions options;
  options.texture = false;
  auto reconstruction = reconstructScan(open, options, job);
  if (!reconstruction) {
    return tl::unexpected(reconstruction.error());
  }
  Scanned scanned{.model = withHash(std::move(reconstruction->model)),
                  .refusal_reasons = reconstruction->refusal_reasons,
                  .camera_model = reconstruction->camera.model,
                  .camera_serial = reconstruction->camera.serial};
  if (const auto facts = readScanFacts(arguments.scan / "camera.json")) {
    scanned.seconds_since_power_on = facts->seconds_since_power_on;
  }
  return scanned;
}

/// @param folder  of the model, empty for a model alone
Expected<Scanned> readModel(const fs::path& file, const fs::path& folder) {
  auto model = readPly(file);
  if (!model) {
    return tl::unexpected(model.error());
  }
  Scanned scanned{.model = std::move(*model)};
  if (std::ranges::find(scanned.model.comments, "fit_for_measurement no") !=
      scanned.model.comments.end()) {
    scanned.refusal_reasons.push_back(
        {"model_unfit", "The scan behind this model was refused for measurement; scan again."});
  }
  if (!folder.empty()) {
    if (const auto camera = readCamera(folder / "keyframes" / "camera.json")) {
      scanned.camera_model = camera->model;
      scanned.camera_serial = camera->serial;
    }
  }
  return scanned;
}

Expected<Scanned> modelOf(const Arguments& arguments, const Job& job) {
  std::error_code unreadable;  // then the reader of scans says what is wrong
  if (fs::is_regular_file(arguments.scan, unreadable)) {
    return readModel(arguments.scan, {});
  }
  if (fs::is_regular_file(arguments.scan / "model.ply", unreadable)) {
    return readModel(arguments.scan / "model.ply", arguments.scan);
  }
  return reconstructed(arguments, job);
}

std::string now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

ChartEntry entryOf(const Scanned& scanned,
                   const Phantom& phantom,
                   const Verification& verification) {
  return {.date = now(),
          .phantom = phantom.name,
          .phantom_sha256 = phantom.stl_sha256,
          .model_sha256 = scanned.model.sha256,
          .camera_model = scanned.camera_model,
          .camera_serial = scanned.camera_serial,
          .seconds_since_power_on = scanned.seconds_since_power_on,
          .version = TARSUS_VERSION,
          .fit = scanned.refusal_reasons.empty(),
          .within_limits = verification.within_limits,
          .values = chartValues(verification)};
}

/// foot_block.phantom.json -> foot_block.chart.jsonl beside it.
fs::path chartBeside(const fs::path& phantom_file, const Phantom& phantom) {
  return phantom_file.parent_path() / (phantom.name + ".chart.jsonl");
}

Expected<nlohmann::json> verify(const Arguments& arguments, bool printing, const Job& job) {
  const auto phantom = readPhantom(arguments.phantom);
  if (!phantom) {
    return tl::unexpected(phantom.error());
  }
  const auto scanned = modelOf(arguments, job);
  if (!scanned) {
    return tl::unexpected(scanned.error());
  }
  job.report("verify", 0.0);
  const VerifyLimits limits;
  auto verification = verifyModel(scanned->model, *phantom, limits);
  if (!verification) {
    return tl::unexpected(verification.error());
  }
  std::ranges::copy(scanned->refusal_reasons, std::back_inserter(verification->reasons));
  verification->within_limits = verification->reasons.empty();
  const fs::path file =
      arguments.chart.empty() ? chartBeside(arguments.phantom, *phantom) : arguments.chart;
  const auto appended = appendToChart(file, entryOf(*scanned, *phantom, *verification));
  if (!appended) {
    return tl::unexpected(appended.error());
  }
  if (printing) {
    printVerification(*phantom, *verification, limits);
    printChart(file, *appended);
  }
  nlohmann::json result = toJson(*verification, limits);
  result["phantom"] = phantom->name;
  result["phantom_sha256"] = phantom->stl_sha256;
  result["model_sha256"] = scanned->model.sha256;
  result["camera"] = {
      {"model", scanned->camera_model},
      {"serial", scanned->camera_serial},
      {"seconds_since_power_on",
       scanned->seconds_since_power_on ? nlohmann::json(*scanned->seconds_since_power_on)
                                       : nlohmann::json()}};
  result["chart"] = chartJson(file, *appended);
  result["version"] = TARSUS_VERSION;
  return result;
}

}  // namespace

void addVerify(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      app, command, "verify", "Does this camera, today, measure a printed phantom rightly?");
  sub->add_option("SCAN", arguments->scan, "Scan of the phantom, or its model (folder or PLY)")
      ->required();
  sub->add_option("PHANTOM", arguments->phantom, "NAME.phantom.json, with NAME.stl beside it")
      ->required();
  sub->add_option("--chart",
                  arguments->chart,
                  "Add the result to this control chart (default: NAME.chart.jsonl beside PHANTOM)")
      ->type_name("FILE");
  addCameraOptions(*sub, arguments->camera);
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) {
      return verify(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
