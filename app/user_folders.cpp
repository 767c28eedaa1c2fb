#include "app/user_folders.h"

#include <pwd.h>
#include <unistd.h>

#include <cstdlib>

namespace tarsus {

std::filesystem::path userDataFolder() {
  const char* data = std::getenv("XDG_DATA_HOME");
  if (data != nullptr && *data == '/') {  // relative ones are to be ignored
    return std::filesystem::path(data) / "tarsus";
  }
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') {
    const passwd* user = getpwuid(getuid());
    home = user != nullptr ? user->pw_dir : "/";
  }
  return std::filesystem::path(home) / ".local" / "share" / "tarsus";
}

std::filesystem::path storePlaceFile() { return userDataFolder() / "records.json"; }

std::filesystem::path calibrationFolder() { return userDataFolder() / "calibration"; }

}  // namespace tarsus
