#pragma once

#include <filesystem>
#include <string_view>

namespace tarsus {

/// A fresh folder that only this user can read, removed with all it holds at the end. One that a
/// program which was killed left behind is removed by the next that makes one.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(std::string_view prefix = "tarsus");
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();

  /// Empty where no folder could be made.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tarsus
