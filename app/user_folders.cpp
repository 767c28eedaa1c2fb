#include "app/user_folders.h"

#include <cstdlib>

namespace tarsus {

std::filesystem::path userDataFolder() {
  const char* data = std::getenv("XDG_DATA_HOME");
  if (data != nullptr && *data == '/') {  // relative ones are to be ignored
    return std::filesystem::path(data) / "tarsus";
  }
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr && *home != '\0' ? home : "/") / ".local" / "share" /
         "tarsus";
}

std::filesystem::path calibrationFolder() { return userDataFolder() / "calibration"; }

}  // namespace tarsus
