#pragma once

#include "reconstruction/base/error.h"

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace tarsus {

/// Files of one frame; paths as they stand on the disk.
struct FrameFiles {
  std::chrono::microseconds timestamp{};  ///< of the depth image
  std::filesystem::path depth;
  std::filesystem::path color;  ///< empty where no colour image is near enough in time
};

/// Pairs the depth and colour images of a TUM RGB-D folder: by associations.txt where there is one,
/// otherwise rgb.txt and depth.txt by nearest time within half a frame. Ordered by time.
/// @errors FileMissing (neither list), ScanEmpty, FileUnreadable (a line that is no entry)
[[nodiscard]] Expected<std::vector<FrameFiles>> listFrames(const std::filesystem::path& folder);

/// Seconds with six decimals, as lists and file names of a scan folder have them.
[[nodiscard]] std::string timeText(std::chrono::microseconds time);

}  // namespace tarsus
