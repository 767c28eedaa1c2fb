#include "reconstruction/base/temporary_folder.h"

#include <signal.h>
#include <stdlib.h>  // mkdtemp
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <system_error>

namespace tarsus {

namespace {

namespace fs = std::filesystem;

/// prefix_PROCESS_XXXXXX of a process that runs no more; only our own can be removed anyway.
void removeLeftBehind(const fs::path& parent, const std::string& prefix) {
  std::error_code ignored;
  for (fs::directory_iterator it(parent, ignored), end; !ignored && it != end;
       it.increment(ignored)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(prefix + "_") || name.size() != name.rfind('_') + 7) {
      continue;
    }
    const std::string number = name.substr(prefix.size() + 1, name.rfind('_') - prefix.size() - 1);
    pid_t process = 0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), process);
    const bool whole = read.ec == std::errc{} && read.ptr == number.data() + number.size();
    if (whole && process > 0 && kill(process, 0) != 0 && errno == ESRCH) {
      fs::remove_all(it->path(), ignored);
    }
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder(std::string_view prefix) {
  std::error_code ignored;
  const fs::path parent = fs::temp_directory_path(ignored);
  removeLeftBehind(parent, std::string(prefix));
  std::string name =
      (parent / (std::string(prefix) + "_" + std::to_string(getpid()) + "_XXXXXX")).string();
  if (mkdtemp(name.data()) != nullptr) {
    path_ = name;
  }
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) {
    std::filesystem::remove_all(path_, ignored);
  }
}

}  // namespace tarsus
