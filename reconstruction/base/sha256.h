#pragma once

#include "reconstruction/base/error.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace tarsus {

/// SHA-256 over bytes fed piece by piece (OpenSSL, which uses the processor's SHA instructions).
class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  ~Sha256();

  void update(std::span<const std::byte> bytes);
  /// Ends the sum; 64 lower-case hexadecimal digits. Call once.
  [[nodiscard]] std::string hex();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of a whole file. @errors FileMissing, FileUnreadable
[[nodiscard]] Expected<std::string> sha256OfFile(const std::filesystem::path& path);

}  // namespace tarsus
