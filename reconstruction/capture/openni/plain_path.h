#pragma once

#include "reconstruction/base/error.h"

#include <filesystem>
#include <string>

namespace tarsus {

/// A path as OpenNI2 can take it: it crashes on letters beyond ASCII and cuts names after 255
/// bytes. Such a path gets a link in a temporary folder, which lives as long as the program.
/// @param path  need not be there yet
/// @errors FileUnwritable (no link could be made)
[[nodiscard]] Expected<std::filesystem::path> plainPath(const std::filesystem::path& path);

/// A camera's address with the path of a simulated one made plain; others stay as they are.
/// @errors those of plainPath
[[nodiscard]] Expected<std::string> plainUri(const std::string& uri);

}  // namespace tarsus
