#include "reconstruction/capture/calibration/calibration_profile.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr double kSameShape = 0.005;  ///< relative difference of width : height

std::optional<int> number(std::string_view text) {
  int value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool digits = std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  return digits && result.ec == std::errc() && result.ptr == text.data() + text.size()
             ? std::optional(value)
             : std::nullopt;
}

/// The day of 2026-03-31 or 2026-03-31T09:30:00Z.
std::optional<std::chrono::sys_days> dayOf(std::string_view date) {
  constexpr std::size_t kDay = 10;
  if (date.size() < kDay || date[4] != '-' || date[7] != '-' ||
      (date.size() > kDay && date[kDay] != 'T')) {
    return std::nullopt;
  }
  const auto year = number(date.substr(0, 4));
  const auto month = number(date.substr(5, 2));
  const auto day = number(date.substr(8, 2));
  if (!year || !month || !day) {
    return std::nullopt;
  }
  const std::chrono::year_month_day calendar{std::chrono::year(*year),
                                             std::chrono::month(static_cast<unsigned>(*month)),
                                             std::chrono::day(static_cast<unsigned>(*day))};
  return calendar.ok() ? std::optional(std::chrono::sys_days(calendar)) : std::nullopt;
}

bool sameSize(const Intrinsics& a, const Intrinsics& b) {
  return a.width == b.width && a.height == b.height;
}

bool sameShape(const Intrinsics& a, const Intrinsics& b) {
  const double shape_a = static_cast<double>(a.width) * b.height;
  const double shape_b = static_cast<double>(b.width) * a.height;
  return std::abs(shape_a - shape_b) <= kSameShape * std::max(shape_a, shape_b);
}

/// Calibrated intrinsics for images of the nominal size; pixel centres are at integers, so the
/// image begins at -0.5.
Intrinsics fitted(const Intrinsics& nominal, const Intrinsics& calibrated) {
  if (sameSize(nominal, calibrated)) {
    return calibrated;
  }
  if (!sameShape(nominal, calibrated)) {
    return nominal;
  }
  const double x = static_cast<double>(nominal.width) / calibrated.width;
  const double y = static_cast<double>(nominal.height) / calibrated.height;
  return {.width = nominal.width,
          .height = nominal.height,
          .fx_px = x * calibrated.fx_px,
          .fy_px = y * calibrated.fy_px,
          .cx_px = x * (calibrated.cx_px + 0.5) - 0.5,
          .cy_px = y * (calibrated.cy_px + 0.5) - 0.5,
          .distortion = calibrated.distortion};
}

std::string sizeText(const Intrinsics& camera) {
  return std::to_string(camera.width) + " x " + std::to_string(camera.height);
}

void warnOfSize(const char* name,
                const Intrinsics& scan,
                const Intrinsics& profile,
                Warnings& warnings) {
  if (sameSize(scan, profile)) {
    return;
  }
  warnings.push_back(
      {"calibration_other_size",
       std::string("The ") + name + " images have " + sizeText(scan) +
           " pixels; the camera was calibrated with " + sizeText(profile) +
           (sameShape(scan, profile) ? ", and that was scaled." : ", which cannot be used here.") +
           " Calibrate again with the size that you scan with."});
}

}  // namespace

std::string calibrationFileName(const CalibrationProfile& profile) {
  std::string name = profile.camera.serial.empty() ? "camera" : profile.camera.serial;
  name += "_" + profile.date;
  std::ranges::replace_if(
      name,
      [](char c) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                           (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
        return !plain;
      },
      '-');
  return name + ".json";
}

FoundCalibration newestCalibration(const fs::path& folder, std::string_view serial) {
  FoundCalibration found;
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".json") {
      files.push_back(entry->path());
    }
  }
  std::ranges::sort(files);
  std::vector<std::string> unreadable;
  for (const fs::path& file : files) {
    auto profile = readCalibration(file);
    if (!profile) {
      unreadable.push_back(file.filename().string() + " (" + profile.error().detail + ")");
    } else if (profile->camera.serial == serial && !serial.empty() &&
               (!found.profile || profile->date >= found.profile->date)) {
      found.profile = std::move(*profile);
    }
  }
  if (!unreadable.empty()) {
    const std::string others =
        unreadable.size() > 1 ? " and " + std::to_string(unreadable.size() - 1) + " more" : "";
    found.warnings.push_back({"calibration_unreadable",
                              folder.string() + " holds files that are no calibration: " +
                                  unreadable.front() + others + ". Remove them."});
  }
  return found;
}

Expected<int> ageInDays(std::string_view date, std::string_view today) {
  const auto from = dayOf(date);
  const auto to = dayOf(today);
  if (!from || !to) {
    return fail(ErrorCode::BadOption,
                "\"" + std::string(from ? today : date) + "\" is no date; write it as 2026-03-31");
  }
  return static_cast<int>((*to - *from).count());
}

Warnings doubtsAboutCalibration(const CalibrationProfile* profile,
                                const RgbdCamera& camera,
                                std::string_view today) {
  if (profile == nullptr) {
    return {{"calibration_missing",
             "There is no calibration of this camera" +
                 (camera.serial.empty() ? std::string() : " (" + camera.serial + ")") +
                 "; lengths may be wrong by some percent. Calibrate it with the chessboard."}};
  }
  Warnings warnings;
  const auto age = ageInDays(profile->date, today);
  if (!age || *age < 0) {
    warnings.push_back({"calibration_date_doubtful",
                        "The calibration's date (" + profile->date +
                            ") does not go with today's (" + std::string(today) +
                            "); check the computer's clock."});
  } else if (*age > kCalibrationGoodFor_days) {
    warnings.push_back({"calibration_old",
                        "The camera was calibrated " + std::to_string(*age) + " days ago; after " +
                            std::to_string(kCalibrationGoodFor_days) +
                            " days it should be calibrated again."});
  }
  warnOfSize("depth", camera.depth, profile->camera.depth, warnings);
  warnOfSize("colour", camera.color, profile->camera.color, warnings);
  if (!profile->depth) {
    warnings.push_back({"depth_camera_not_calibrated",
                        "The calibration was made without infrared images: the depth camera keeps "
                        "its nominal focal length."});
  }
  return warnings;
}

RgbdCamera calibrated(const RgbdCamera& nominal, const CalibrationProfile& profile) {
  RgbdCamera camera = nominal;
  camera.depth = fitted(nominal.depth, profile.camera.depth);
  camera.color = fitted(nominal.color, profile.camera.color);
  camera.color_from_depth = profile.camera.color_from_depth;
  return camera;
}

}  // namespace tarsus
