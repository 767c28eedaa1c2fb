#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <filesystem>

namespace tarsus {

/// Reads camera.json (design.md section 3); unknown fields are ignored.
/// @errors FileMissing, CameraFactsInvalid (which field, and what it must be)
[[nodiscard]] Expected<RgbdCamera> readCamera(const std::filesystem::path& path);

/// @errors FileUnwritable, DiskFull
[[nodiscard]] Expected<void> writeCamera(const std::filesystem::path& path,
                                         const RgbdCamera& camera);

}  // namespace tarsus
