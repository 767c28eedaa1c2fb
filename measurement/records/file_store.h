#pragma once

#include "measurement/records/vault.h"
#include "reconstruction/base/error.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// Encrypted files in `folder`/ab/cdef..., each named by a keyed hash (BLAKE2b) of its content:
/// the same content is kept once, and a name tells nobody without the key what it holds, not even
/// whether it equals a file that one has.
class FileStore {
 public:
  explicit FileStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Flushed to the disk before it returns.
  /// @return the name to keep in a record
  /// @errors FileMissing, FileUnreadable, FileUnwritable, DiskFull, StoreLocked
  [[nodiscard]] Expected<std::string> put(Vault& vault, const std::filesystem::path& source);
  /// Writes the content to `target` once all of it was found to be as it was put.
  /// @errors FileMissing, StoreDamaged (both name the file to restore), and those of writing
  [[nodiscard]] Expected<void> get(Vault& vault,
                                   std::string_view name,
                                   const std::filesystem::path& target) const;
  /// Reads and checks the file without writing it anywhere.
  [[nodiscard]] Expected<void> verify(Vault& vault, std::string_view name) const;
  /// A file that is not there is no failure.
  [[nodiscard]] Expected<void> remove(std::string_view name);
  /// The names of all files, sorted.
  [[nodiscard]] Expected<std::vector<std::string>> names() const;
  [[nodiscard]] std::filesystem::path pathOf(std::string_view name) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace tarsus
