#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/camera_file.h"

#include <filesystem>
#include <string_view>

namespace tarsus {

/// A camera as its scans will describe it.
struct KnownCamera {
  RgbdCamera camera;
  ScanFacts facts;  ///< its depth correction
  Warnings warnings;
  bool calibrated = false;  ///< by a profile
};

/// A camera by its calibration.
/// @param sensor       as nominal
/// @param calibration  a profile, or a folder of them of which the newest of this serial number is
///                     taken; where there is none the camera stays nominal, with a warning
/// @param today        ISO 8601
/// @errors those of readCalibration, for a profile that is named; BadOption where that is of
/// another
///         camera
[[nodiscard]] Expected<KnownCamera> knownCamera(const RgbdCamera& sensor,
                                                const std::filesystem::path& calibration,
                                                std::string_view today);

}  // namespace tarsus
