#include "reconstruction/base/temporary_folder.h"

#include <stdlib.h>  // mkdtemp

#include <string>
#include <system_error>

namespace tarsus {

TemporaryFolder::TemporaryFolder(std::string_view prefix) {
  std::error_code ignored;
  std::string name =
      (std::filesystem::temp_directory_path(ignored) / (std::string(prefix) + "_XXXXXX")).string();
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
