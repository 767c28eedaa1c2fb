#include "app/cli/checks.h"
#include "app/cli/command.h"
#include "app/user_folders.h"
#include "reconstruction/capture/frame_preparation.h"
#include "reconstruction/capture/openni/oni_file.h"
#include "reconstruction/capture/openni/openni_camera.h"
#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/scan_recorder.h"
#include "reconstruction/pipeline/live_scan.h"
#include "reconstruction/pipeline/model_record.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

Expected<nlohmann::json> printCameras(bool print) {
  const auto cameras = listCameras();
  if (!cameras) {
    return tl::unexpected(cameras.error());
  }
  nlohmann::json list = nlohmann::json::array();
  for (const CameraInfo& c : *cameras) {
    list.push_back({{"uri", c.uri},
                    {"vendor", c.vendor},
                    {"name", c.name},
                    {"profile", c.profile},
                    {"simulated", c.simulated}});
    if (print) {
      std::printf("%s\n  %s %s%s\n",
                  c.uri.c_str(),
                  c.vendor.c_str(),
                  c.name.c_str(),
                  c.profile.empty() && !c.simulated ? " (not known to this program)" : "");
    }
  }
  if (print && cameras->empty()) {
    std::printf(
        "No depth camera is plugged in. A recorded scan can stand for one: "
        "--simulated SCAN.\n");
  }
  return nlohmann::json{{"cameras", list}};
}

struct RecordArguments {
  fs::path out;
  std::string device;
  fs::path simulated;
  std::optional<fs::path> calibration;  ///< a profile, or a folder of them; else the user's own
  double seconds = 20.0;
};

/// By the calibration that is named, which must be there, or else the newest of the user's own.
/// @errors BadOption, those of knownCamera
Expected<KnownCamera> cameraAsCalibrated(const OpenNiCamera& camera,
                                         const std::optional<fs::path>& calibration) {
  auto known = knownCamera(camera, calibration.value_or(calibrationFolder()), todayUtc());
  if (known && calibration && !known->calibrated) {
    return fail(ErrorCode::BadOption,
                "there is no calibration of this camera at \"" + calibration->string() + "\"");
  }
  return known;
}

/// Where the frames go while they come: the folder that is asked for, or one beside the recording.
fs::path folderFor(const fs::path& out) {
  return out.extension() == ".oni" ? fs::path(out.string() + ".scan") : out;
}

/// Looks at some frames whether their depth can be a foot's: a wrong unit or a broken camera is
/// told when the scan is taken, not when the patient is gone.
class DepthLook {
 public:
  explicit DepthLook(const RgbdCamera& camera)
      : units_per_m_(camera.depth_units_per_m),
        every_(std::max(1, static_cast<int>(camera.frames_per_s / 6.0))) {}
  /// On the camera's thread; a millisecond for one frame, six times a second.
  void add(const RgbdFrame& frame) {
    const auto median_mm = frame.index % every_ == 0 ? medianDepth(frame.depth) : std::nullopt;
    if (median_mm) {
      ++looks_;
      doubtful_ += checkMedianDepth(*median_mm, units_per_m_) ? 0 : 1;
    }
  }
  [[nodiscard]] Warnings warnings() const {
    if (doubtful_ == 0) {
      return {};
    }
    return {{"depth_implausible",
             "In " + std::to_string(doubtful_) + " of " + std::to_string(looks_) +
                 " frames that were looked at, the depth lies outside 0.15 to 2 m: the depth unit "
                 "is wrong, the camera is broken, or it does not look at a foot. Check it with a "
                 "phantom."}};
  }

 private:
  double units_per_m_;
  int every_;
  int looks_ = 0;
  int doubtful_ = 0;
};

/// What went wrong while the frames came.
Warnings troubles(const CaptureCounts& captured, int dropped) {
  Warnings warnings;
  if (captured.unplugged > 0) {
    warnings.push_back({"camera_unplugged",
                        "The camera was unplugged " + std::to_string(captured.unplugged) +
                            (captured.unplugged == 1 ? " time" : " times") +
                            "; the scan goes on after the gap. Look whether the foot is seen "
                            "whole, or take the scan again."});
  }
  if (dropped > 0) {
    warnings.push_back({"frames_dropped",
                        std::to_string(dropped) +
                            " frames were lost between the camera and the disk. Where there are "
                            "many, close other programs, and plug the camera into a port of its "
                            "own."});
  }
  if (captured.unpaired * 5 > captured.pairs) {
    warnings.push_back({"color_missing",
                        std::to_string(captured.unpaired) + " of " +
                            std::to_string(captured.pairs) +
                            " frames came without colour; the model will lack it in places. Plug "
                            "the camera in again and take the scan anew."});
  }
  return warnings;
}

/// Until the time is over, the camera fails for good, the disk is full, or Ctrl-C.
Expected<void> recordFrames(
    OpenNiCamera& camera, ScanRecorder& recorder, DepthLook& look, double seconds, const Job& job) {
  constexpr auto kLook = std::chrono::milliseconds(50);
  constexpr auto kWithout = std::chrono::seconds(10);  // to plug a camera in again
  std::optional<std::chrono::microseconds> first;
  std::atomic<std::int64_t> passed_us = 0;
  const auto wanted_us = static_cast<std::int64_t>(1e6 * seconds);
  const auto half_us = static_cast<std::int64_t>(0.5e6 / camera.camera().frames_per_s);
  auto started = camera.start([&](RgbdFrame frame) {
    first = first.value_or(frame.timestamp);
    const std::int64_t at_us = (frame.timestamp - *first).count();
    if (at_us < wanted_us - half_us) {
      look.add(frame);
      recorder.add(std::make_shared<const RgbdFrame>(std::move(frame)));
    }
    passed_us = at_us;
  });
  if (!started) {
    return started;
  }
  auto seen = std::chrono::steady_clock::now();
  std::int64_t before_us = -1;
  while (passed_us < wanted_us - half_us && !job.stopped() && !recorder.failure()) {
    std::this_thread::sleep_for(kLook);
    const auto now = std::chrono::steady_clock::now();
    if (passed_us != before_us) {
      seen = now;
      before_us = passed_us;
    }
    if (now - seen > kWithout) {
      camera.stop();
      return fail(ErrorCode::CameraFailed, "no frame came for 10 s");
    }
    const bool gone = camera.state() == CameraState::Unplugged;
    job.report(gone ? "camera unplugged" : "record",
               static_cast<double>(passed_us) / static_cast<double>(wanted_us));
  }
  camera.stop();
  return {};
}

Expected<nlohmann::json> record(const RecordArguments& arguments, bool print, const Job& job) {
  const fs::path folder = folderFor(arguments.out);
  std::error_code ignored;
  if (folder != arguments.out && fs::exists(arguments.out, ignored)) {
    return fail(ErrorCode::BadOption,
                arguments.out.string() + " is there already; move it away or give another name");
  }
  // Before the camera is opened, which takes a second in which somebody clicks twice.
  const auto claim = ScanClaim::take(folder);
  if (!claim) {
    return tl::unexpected(claim.error());
  }
  const std::string uri =
      arguments.simulated.empty() ? arguments.device : simulatedUri(arguments.simulated.string());
  auto camera = OpenNiCamera::open(uri);
  if (!camera) {
    return tl::unexpected(camera.error());
  }
  const auto known = cameraAsCalibrated(**camera, arguments.calibration);
  if (!known) {
    return tl::unexpected(known.error());
  }
  auto recorder =
      ScanRecorder::create(folder, known->camera, arguments.seconds, {.facts = known->facts});
  if (!recorder) {
    return tl::unexpected(recorder.error());
  }
  DepthLook look(known->camera);
  const auto recorded = recordFrames(**camera, **recorder, look, arguments.seconds, job);
  auto finished = (*recorder)->finish();
  const RecorderCounts kept = (*recorder)->counts();
  if (!recorded || !finished) {
    const Error& why = !recorded ? recorded.error() : finished.error();
    return kept.written == 0 ? fail(why.code, why.detail)
                             : fail(why.code,
                                    why.detail + "; the first " + std::to_string(kept.written) +
                                        " frames are kept in " + folder.string());
  }
  const CaptureCounts counts = (*camera)->counts();
  if (kept.written == 0) {
    return fail(ErrorCode::ScanEmpty, "the camera gave no frame");
  }
  if (folder != arguments.out) {
    Job to_the_end = job;
    to_the_end.stop = {};  // Ctrl-C ends the recording, not what is made of it
    if (auto written = writeOniRecording(folder, arguments.out, to_the_end); !written) {
      return fail(written.error().code,
                  written.error().detail + "; the frames are kept in " + folder.string());
    }
    fs::remove_all(folder, ignored);
  }
  const int dropped = counts.dropped + kept.dropped;
  Warnings warnings = known->warnings;
  for (const Warnings& more : {troubles(counts, dropped), look.warnings()}) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  if (print) {
    std::printf("Wrote %s: %d frames, %.0f MB; %d dropped, %d without colour\n",
                arguments.out.c_str(),
                kept.written,
                kept.megabytes,
                dropped,
                counts.unpaired);
    for (const Warning& warning : warnings) {
      std::printf("  %s\n", warning.text.c_str());
    }
  }
  return nlohmann::json{{"frames", kept.written},
                        {"dropped", dropped},
                        {"unpaired", counts.unpaired},
                        {"times_unplugged", counts.unplugged},
                        {"megabytes", kept.megabytes},
                        {"warnings", toJson(warnings)}};
}

}  // namespace

void addDevices(CLI::App& app, Command& command) {
  auto simulated = std::make_shared<fs::path>();
  CLI::App* sub = addCommand(app, command, "devices", "List the depth cameras that are plugged in");
  sub->add_option("--simulated", *simulated, "A recorded scan that stands for a camera")
      ->type_name("SCAN");
  sub->callback([&command, simulated] {
    command.run = [&command, simulated](const Job& /*job*/) {
      if (!simulated->empty()) {
        if (auto usable = readCamera(*simulated / "camera.json"); !usable) {
          return Expected<nlohmann::json>(tl::unexpected(usable.error()));
        }
        announceSimulatedCamera(simulated->string());
      }
      return printCameras(!command.quiet && command.json_file != "-");
    };
  });
}

void addRecord(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* sub = addCommand(app, command, "record", "Record a scan from a depth camera");
  sub->add_option("OUT", arguments->out, "The recording (.oni) or scan folder to write")
      ->required()
      ->check(notEmpty());
  auto* device =
      sub->add_option("--device", arguments->device, "Which camera, as `devices` names it")
          ->type_name("URI");
  sub->add_option("--simulated", arguments->simulated, "A recorded scan that stands for a camera")
      ->type_name("SCAN")
      ->excludes(device);
  sub->add_option(
         "--calibration",
         arguments->calibration,
         "What `calibrate` wrote, or a folder of it; else the newest of this camera is taken")
      ->type_name("FILE");
  sub->add_option("--seconds", arguments->seconds, "How long; Ctrl-C ends it earlier")
      ->check(inRange(0.1, 600.0))
      ->capture_default_str();
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& job) {
      return record(*arguments, !command.quiet && command.json_file != "-", job);
    };
  });
}

}  // namespace tarsus
