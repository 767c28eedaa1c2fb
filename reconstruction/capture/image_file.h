#pragma once

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/image.h"

#include <cstdint>
#include <filesystem>

namespace tarsus {

/// Reads a 16-bit one-channel PNG: depth in units of its camera, or infrared grey levels.
/// @errors as readDepthImage
[[nodiscard]] Expected<Image<std::uint16_t>> readNumbers(const std::filesystem::path& path);
/// Reads a 16-bit one-channel depth PNG.
/// @return z [mm], 0 where nothing was measured
/// @errors FileMissing, FileUnreadable (truncated too), DepthFormatWrong
[[nodiscard]] Expected<DepthImage> readDepthImage(const std::filesystem::path& path,
                                                  double units_per_m);
/// Writes z [mm] rounded to 1 / units_per_m, as 16-bit PNG; what does not fit becomes 0.
[[nodiscard]] Expected<void> writeDepthImage(const std::filesystem::path& path,
                                             const DepthImage& depth,
                                             double units_per_m,
                                             Flush flush = Flush::ToDisk);

/// Reads PNG or JPEG as sRGB. @errors FileMissing, FileUnreadable
[[nodiscard]] Expected<ColorImage> readColorImage(const std::filesystem::path& path);
/// Writes PNG or JPEG (quality 95) by the file's extension.
[[nodiscard]] Expected<void> writeColorImage(const std::filesystem::path& path,
                                             const ColorImage& color,
                                             Flush flush = Flush::ToDisk);

}  // namespace tarsus
