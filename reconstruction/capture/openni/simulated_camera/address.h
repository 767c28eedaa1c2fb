#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tarsus {

/// What a simulated camera does wrong, on request.
struct CameraFault {
  enum class Kind {
    None,
    Unplug,   ///< gone from `from_s` to `to_s` after the first frame of the device
    Stall,    ///< no frames in that time, the device stays
    Drop,     ///< every third frame is missing in that time
    Unit,     ///< depth 8 times as large, as from a driver that names its unit wrongly
    Garbage,  ///< depth and colour without sense in that time
  };
  Kind kind = Kind::None;
  double from_s = 0.0;
  double to_s = 1e9;
};

/// A simulated camera is named by what it shows: `tarsus:/path/to/scan`, with what it does wrong
/// behind it: `?fault=unplug,2,4` (kind, from, to in seconds; the times may be left out), or with
/// `?once`: each frame once, as fast as it can be read, for a recording of the whole scan.
struct SimulatedAddress {
  std::filesystem::path scan;
  CameraFault fault;
  bool once = false;
};

inline constexpr std::string_view kSimulatedScheme = "tarsus:";
inline constexpr std::string_view kSimulatedOnce = "?once";
/// Its value, an address, is the camera that is found without being asked for.
inline constexpr const char* kSimulatedVariable = "TARSUS_SIMULATED_CAMERA";
inline constexpr const char* kSimulatedVendor = "Tarsus";

/// Nothing where the text is no such address.
[[nodiscard]] std::optional<SimulatedAddress> parseSimulatedAddress(std::string_view uri);

}  // namespace tarsus
