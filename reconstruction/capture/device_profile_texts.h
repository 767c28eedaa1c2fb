#pragma once

#include <span>
#include <string_view>

namespace tarsus {

struct DeviceProfileText {
  std::string_view file;
  std::string_view text;
};

/// The files of resources/devices; their table is written by CMake.
[[nodiscard]] std::span<const DeviceProfileText> deviceProfileTexts();

}  // namespace tarsus
