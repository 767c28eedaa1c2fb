#include "app/cli/checks.h"
#include "app/cli/command.h"
#include "app/user_folders.h"
#include "reconstruction/capture/calibration/calibration.h"
#include "reconstruction/capture/calibration/calibration_folder.h"
#include "reconstruction/capture/calibration/calibration_profile.h"
#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/pipeline/live_calibration.h"
#include "reconstruction/pipeline/model_record.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  fs::path views;
  fs::path out;  ///< empty: the user's own calibrations
  bool live = false;
  std::string device;
  fs::path simulated;
  int wanted_views = 20;
  bool infrared = true;
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

const char* nameOf(BoardLook look) {
  switch (look) {
    case BoardLook::NotFound:
      return "show the whole board";
    case BoardLook::Moving:
      return "hold the board still";
    case BoardLook::Seen:
      return "move or tilt the board";
    case BoardLook::Taken:
      return "view taken";
  }
  return "";
}

/// @errors those of OpenNiCamera::open and takeCalibrationViews
Expected<void> takeViews(const Arguments& arguments, const Job& job) {
  const auto camera = OpenNiCamera::open(
      arguments.simulated.empty() ? arguments.device : simulatedUri(arguments.simulated.string()));
  if (!camera) {
    return tl::unexpected(camera.error());
  }
  const LiveCalibrationOptions options{.board = arguments.options.board,
                                       .views = arguments.wanted_views,
                                       .infrared = arguments.infrared};
  const auto taken = takeCalibrationViews(
      **camera,
      arguments.views,
      options,
      [&](const auto& view) {
        job.report(nameOf(view.look), static_cast<double>(view.taken) / options.views);
      },
      job);
  if (!taken) {
    return fail(
        taken.error().code,
        taken.error().detail + "; views taken so far are kept in " + arguments.views.string());
  }
  return {};
}

/// From a folder of views, or of a recorded scan.
Expected<CalibrationCapture> readViews(const Arguments& arguments, const Job& job) {
  std::error_code ignored;
  if (arguments.views.extension() == ".oni") {
    return fail(ErrorCode::BadOption,
                "a calibration needs the sensor's own numbers; record into a folder (OUT without "
                ".oni), and calibrate from that");
  }
  for (const char* list : {"depth.txt", "associations.txt"}) {
    if (fs::exists(arguments.views / list, ignored)) {
      return viewsOfScan(arguments.views, arguments.options.board, job);
    }
  }
  return readCalibrationFolder(arguments.views);
}

Expected<nlohmann::json> calibrate(Arguments arguments, bool printing, const Job& job) {
  arguments.options.date = todayUtc();
  Job to_the_end = job;
  if (arguments.live) {
    if (auto taken = takeViews(arguments, job); !taken) {
      return tl::unexpected(taken.error());
    }
    to_the_end.stop = {};  // Ctrl-C ends the taking of views, not what is made of them
  }
  const auto capture = readViews(arguments, to_the_end);
  if (!capture) {
    return tl::unexpected(capture.error());
  }
  const auto profile = calibrateCameras(*capture, arguments.options, to_the_end);
  if (!profile && arguments.live) {
    return fail(profile.error().code,
                profile.error().detail + "; the views are kept in " + arguments.views.string() +
                    ", and the same command adds more to them");
  }
  if (!profile) {
    return tl::unexpected(profile.error());
  }
  std::error_code ignored;
  const fs::path out = arguments.out.empty() ? calibrationFolder() : arguments.out;
  const fs::path file = arguments.out.empty() || fs::is_directory(out, ignored)
                            ? out / calibrationFileName(*profile)
                            : out;
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
                        {"views_used", profile->color.views},
                        {"warnings", toJson(profile->warnings)}};
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
  sub->add_option("VIEWS",
                  arguments->views,
                  "Folder with color/, ir/ and depth/ of the board, or of a recorded scan of it")
      ->required();
  sub->add_option(
      "OUT",
      arguments->out,
      "The calibration to write (.json), or a folder of them; else where `record` looks");
  auto* device =
      sub->add_option("--device",
                      arguments->device,
                      "Take the views now with this camera, into VIEWS (\"\": the first)")
          ->type_name("URI");
  auto* simulated =
      sub->add_option("--simulated", arguments->simulated, "The same from a recorded scan")
          ->type_name("SCAN")
          ->excludes(device);
  sub->add_option(
         "--views", arguments->wanted_views, "How many views are taken; Ctrl-C ends earlier")
      ->check(CLI::Range(8, 100))
      ->capture_default_str();
  sub->add_flag("!--no-infrared",
                arguments->infrared,
                "No infrared pictures are taken: the depth camera's lens stays nominal");
  sub->add_option("--columns", arguments->options.board.columns, "Inner corners across")
      ->capture_default_str();
  sub->add_option("--rows", arguments->options.board.rows, "Inner corners down")
      ->capture_default_str();
  sub->add_option("--square-mm", arguments->options.board.square_mm, "Side of one square")
      ->capture_default_str();
  sub->add_flag("--wall",
                arguments->options.board_on_wall,
                "The board lies flat on a wall: the whole wall is compared");
  sub->callback([&command, arguments, device, simulated] {
    arguments->live = device->count() + simulated->count() > 0;
    command.run = [&command, arguments](const Job& job) {
      return calibrate(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
