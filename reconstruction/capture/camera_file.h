#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/depth_correction.h"
#include "reconstruction/scene/frame.h"

#include <filesystem>
#include <optional>

namespace tarsus {

/// Reads camera.json (design.md section 3); unknown fields are ignored.
/// @errors FileMissing, CameraFactsInvalid (which field, and what it must be)
[[nodiscard]] Expected<RgbdCamera> readCamera(const std::filesystem::path& path);

/// What camera.json may say of this very scan, beyond its camera.
struct ScanFacts {
  std::optional<DepthCorrection> depth_correction;  ///< takes the place of the device profile's
  std::optional<double> seconds_since_power_on;     ///< of the camera, when the scan began
};

/// @errors as readCamera
[[nodiscard]] Expected<ScanFacts> readScanFacts(const std::filesystem::path& path);

/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeCamera(const std::filesystem::path& path,
                                         const RgbdCamera& camera,
                                         const ScanFacts& facts = {});

}  // namespace tarsus
