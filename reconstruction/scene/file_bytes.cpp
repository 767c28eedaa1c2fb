#include "reconstruction/scene/file_bytes.h"

#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>

namespace tarsus {

Expected<std::string> readFileBytes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return fail(ErrorCode::FileMissing, path.string());
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file.is_open()) {
    return fail(ErrorCode::FileUnreadable, path.string());
  }
  try {
    std::string bytes(size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(file.gcount()) != size) {
      return fail(ErrorCode::FileUnreadable, path.string() + " became shorter while it was read");
    }
    return bytes;
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::FileUnreadable, path.string() + " is larger than the memory");
  } catch (const std::length_error&) {
    return fail(ErrorCode::FileUnreadable, path.string() + " is larger than the memory");
  }
}

}  // namespace tarsus
