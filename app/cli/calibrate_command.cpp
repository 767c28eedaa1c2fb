#include "app/cli/command.h"
#include "reconstruction/capture/calibration/calibration.h"
#include "reconstruction/capture/calibration/calibration_folder.h"
#include "reconstruction/capture/calibration/calibration_profile.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>

namespace tarsus {
namespace {

struct Arguments {
  std::filesystem::path views;
  std::filesystem::path out;
  CalibrationOptions options;
};

void print(const char* name, const CameraFit& fit) {
  std::printf("%-22s %2d views, %.3f px, %.0f to %.0f mm, corners in %.0f %% of the picture\n",
              name,
              fit.views,
              fit.rms_px,
              fit.near_mm,
              fit.far_mm,
              100.0 * fit.coverage);
}

void print(const CalibrationProfile& profile) {
  print("colour camera", profile.color);
  if (profile.depth) {
    print("depth camera", *profile.depth);
  }
  if (const auto& depth = profile.depth_fit) {
    std::printf("%-22s %2d views, %.2f mm before, %.2f mm after correction, %.0f to %.0f mm\n",
                "depth against board",
                depth->views,
                depth->rms_before_mm,
                depth->rms_after_mm,
                depth->near_mm,
                depth->far_mm);
  }
  for (const ViewResult& view : profile.views) {
    for (const std::string* why :
         {&view.color_refused, &view.infrared_refused, &view.depth_refused}) {
      if (!why->empty()) {
        std::printf("  view %s left out: %s\n", view.name.c_str(), why->c_str());
      }
    }
  }
  for (const Warning& warning : profile.warnings) {
    std::printf("  %s\n", warning.text.c_str());
  }
}

Expected<nlohmann::json> calibrate(Arguments arguments, bool printing, const Job& job) {
  arguments.options.date = todayUtc();
  const auto capture = readCalibrationFolder(arguments.views);
  if (!capture) {
    return tl::unexpected(capture.error());
  }
  const auto profile = calibrateCameras(*capture, arguments.options, job);
  if (!profile) {
    return tl::unexpected(profile.error());
  }
  std::error_code ignored;
  const std::filesystem::path file = std::filesystem::is_directory(arguments.out, ignored)
                                         ? arguments.out / calibrationFileName(*profile)
                                         : arguments.out;
  if (auto written = writeCalibration(file, *profile); !written) {
    return tl::unexpected(written.error());
  }
  if (printing) {
    print(*profile);
    std::printf("Wrote %s\n", file.c_str());
  }
  nlohmann::json result{{"file", file.string()},
                        {"serial", profile->camera.serial},
                        {"date", profile->date},
                        {"color_rms_px", profile->color.rms_px},
                        {"views_used", profile->color.views}};
  if (profile->depth) {
    result["depth_rms_px"] = profile->depth->rms_px;
  }
  return result;
}

}  // namespace

std::string todayUtc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts);
  return text.data();
}

void addCalibrate(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub =
      addCommand(app, command, "calibrate", "Calibrate a camera from views of a chessboard");
  sub->add_option("VIEWS", arguments->views, "Folder with color/, ir/ and depth/ of the board")
      ->required();
  sub->add_option("OUT", arguments->out, "The calibration to write (.json), or a folder of them")
      ->required();
  sub->add_option("--columns", arguments->options.board.columns, "Inner corners across")
      ->capture_default_str();
  sub->add_option("--rows", arguments->options.board.rows, "Inner corners down")
      ->capture_default_str();
  sub->add_option("--square-mm", arguments->options.board.square_mm, "Side of one square")
      ->capture_default_str();
  sub->add_flag("--wall",
                arguments->options.board_on_wall,
                "The board lies flat on a wall: the whole wall is compared");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) {
      return calibrate(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
