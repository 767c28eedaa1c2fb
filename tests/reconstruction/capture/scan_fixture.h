#pragma once

#include "reconstruction/capture/scan_folder.h"

#include <filesystem>
#include <string>

namespace tarsus {

/// 16 x 12 pixels, 0.125 mm units, an offset colour camera: small, but with every fact set.
[[nodiscard]] RgbdCamera smallCamera();

/// Frame `index` at index / 30 s: depths around 400 mm that differ at each pixel and frame.
[[nodiscard]] RgbdFrame smallFrame(int index);

/// Writes a scan of `count` such frames.
void writeSmallScan(const std::filesystem::path& folder, int count);

void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace tarsus
