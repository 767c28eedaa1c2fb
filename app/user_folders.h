#pragma once

#include <filesystem>

namespace tarsus {

/// Where the user's own data lie: $XDG_DATA_HOME/tarsus, or ~/.local/share/tarsus (XDG Base
/// Directory Specification 0.8). Not made by asking.
[[nodiscard]] std::filesystem::path userDataFolder();

/// Says where this computer's records lie (measurement/records/place_file.h).
[[nodiscard]] std::filesystem::path storePlaceFile();

/// Calibrations, by serial number and date: where `calibrate` puts them and scans look for them.
[[nodiscard]] std::filesystem::path calibrationFolder();

}  // namespace tarsus
