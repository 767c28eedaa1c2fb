#include "reconstruction/capture/calibration/known_camera.h"

#include "reconstruction/capture/calibration/calibration_profile.h"

#include <utility>

namespace tarsus {
namespace {

/// @errors those of readCalibration
Expected<FoundCalibration> findCalibration(const std::filesystem::path& calibration,
                                           std::string_view serial) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(calibration, ignored)) {
    auto read = readCalibration(calibration);
    if (!read) {
      return tl::unexpected(read.error());
    }
    if (!read->camera.serial.empty() && !serial.empty() && read->camera.serial != serial) {
      return fail(ErrorCode::BadOption,
                  calibration.string() + " is the calibration of camera " + read->camera.serial +
                      ", and this is camera " + std::string(serial));
    }
    return FoundCalibration{.profile = std::move(*read), .warnings = {}};
  }
  return newestCalibration(calibration, serial);
}

}  // namespace

Expected<KnownCamera> knownCamera(const RgbdCamera& sensor,
                                  const std::filesystem::path& calibration,
                                  std::string_view today) {
  auto found = findCalibration(calibration, sensor.serial);
  if (!found) {
    return tl::unexpected(found.error());
  }
  KnownCamera known{.camera = sensor, .facts = {}, .warnings = std::move(found->warnings)};
  const auto& profile = found->profile;
  const Warnings doubts = doubtsAboutCalibration(profile ? &*profile : nullptr, sensor, today);
  known.warnings.insert(known.warnings.end(), doubts.begin(), doubts.end());
  if (profile) {
    known.calibrated = true;
    known.camera = calibrated(sensor, *profile);
    known.facts.depth_correction = profile->depth_correction;
  }
  return known;
}

}  // namespace tarsus
