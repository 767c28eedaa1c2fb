#include "tests/support/shared_data.h"

#include <cstdlib>

namespace tarsus {

std::optional<std::filesystem::path> sharedData(const std::string& name) {
  const char* given = std::getenv("TARSUS_SHARED_DATA");
  const std::filesystem::path base =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(TARSUS_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path folder = base / name;
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    return std::nullopt;
  }
  return folder;
}

}  // namespace tarsus
