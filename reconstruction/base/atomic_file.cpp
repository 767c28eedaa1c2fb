#include "reconstruction/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <tuple>
#include <utility>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> systemFailure(int error_number, const fs::path& path) {
  const bool full = error_number == ENOSPC || error_number == EDQUOT;
  return fail(full ? ErrorCode::DiskFull : ErrorCode::FileUnwritable,
              path.string() + ": " + std::generic_category().message(error_number));
}

Expected<void> writeAll(int file, std::span<const std::byte> bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      return systemFailure(errno, path);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

/// A rename survives a power cut only when the data reached the disk before it, and the folder
/// that names it after it.
Expected<void> flushToDisk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return systemFailure(errno, path);
  }
  const int result = ::fsync(file);
  const int error_number = errno;
  ::close(file);
  if (result != 0 && error_number != EINVAL) {  // EINVAL: a pipe or special file
    return systemFailure(error_number, path);
  }
  return {};
}

Expected<void> makeParent(const fs::path& path) {
  std::error_code error;
  if (path.has_parent_path()) {
    fs::create_directories(path.parent_path(), error);
  }
  return error ? Expected<void>(systemFailure(error.value(), path.parent_path()))
               : Expected<void>();
}

/// Removes the temporary file however the write ends; after the rename there is none.
class Remover {
 public:
  explicit Remover(fs::path path) : path_(std::move(path)) {}
  Remover(const Remover&) = delete;
  Remover& operator=(const Remover&) = delete;
  ~Remover() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }

 private:
  fs::path path_;
};

/// A device or pipe (/dev/stdout) is written to, never replaced.
bool isSpecial(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return !error && fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// Where a link points, so that the link stays one.
fs::path behindLinks(const fs::path& path) {
  std::error_code error;
  const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  return error ? path : target;
}

}  // namespace

Expected<void> writeFileAtomically(
    const fs::path& asked_path,
    const std::function<Expected<void>(const fs::path& temporary)>& write,
    Flush flush) {
  if (isSpecial(asked_path)) {
    return write(asked_path);
  }
  const fs::path path = behindLinks(asked_path);
  if (auto made = makeParent(path); !made) {
    return made;
  }
  const fs::path temporary =
      path.parent_path() / ("." + path.stem().string() + ".part" + std::to_string(::getpid()) +
                            path.extension().string());
  const Remover remover(temporary);
  auto written = write(temporary);
  if (written && flush == Flush::ToDisk) {
    written = flushToDisk(temporary);
  }
  if (!written) {
    Error error = written.error();
    // The user knows the file by its own name, not by the one it was written under.
    if (const auto at = error.detail.find(temporary.string()); at != std::string::npos) {
      error.detail.replace(at, temporary.string().size(), path.string());
    }
    return tl::unexpected(std::move(error));
  }
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error) {
    return systemFailure(error.value(), path);
  }
  if (flush == Flush::ToDisk) {
    // Not every file system can flush a folder; the file itself is whole in any case.
    std::ignore = flushToDisk(path.has_parent_path() ? path.parent_path() : fs::path("."));
  }
  return {};
}

Expected<void> writeFileAtomically(const fs::path& path,
                                   std::span<const std::byte> bytes,
                                   Flush flush) {
  return writeFileAtomically(
      path, [&](const fs::path& temporary) { return writeBytes(temporary, bytes); }, flush);
}

Expected<void> writeTextAtomically(const fs::path& path, std::string_view text) {
  return writeFileAtomically(path, std::as_bytes(std::span(text)));
}

Expected<void> writeBytes(const fs::path& path, std::span<const std::byte> bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) {
    return systemFailure(errno, path);
  }
  auto written = writeAll(file, bytes, path);
  if (::close(file) != 0 && written) {
    return systemFailure(errno, path);
  }
  return written;
}

Expected<std::string> readTextFile(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return fail(ErrorCode::FileMissing, path.string());
  }
  if (fs::is_directory(path, error)) {  // libstdc++ opens a folder and then throws on reading
    return fail(ErrorCode::FileUnreadable, path.string() + " is a folder");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) {
    return fail(ErrorCode::FileUnreadable, path.string());
  }
  constexpr std::size_t kLargest = std::size_t{1} << 30U;  // a device may never end
  constexpr std::size_t kStep = std::size_t{1} << 20U;
  try {
    std::string bytes;
    std::size_t got = kStep;
    while (got == kStep && bytes.size() < kLargest) {
      bytes.resize(bytes.size() + kStep);
      file.read(bytes.data() + bytes.size() - kStep, kStep);
      got = static_cast<std::size_t>(file.gcount());
      bytes.resize(bytes.size() - kStep + got);
    }
    return bytes.size() < kLargest ? Expected<std::string>(std::move(bytes))
                                   : fail(ErrorCode::FileUnreadable,
                                          path.string() + " is larger than a file of this kind");
  } catch (const std::ios_base::failure&) {
    return fail(ErrorCode::FileUnreadable, path.string());
  }
}

}  // namespace tarsus
