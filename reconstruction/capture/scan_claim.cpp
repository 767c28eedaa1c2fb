#include "reconstruction/capture/scan_recorder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <utility>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = ".recording";

bool listsFrames(const fs::path& folder) {
  std::ifstream list(folder / "depth.txt");
  for (std::string line; std::getline(list, line);) {
    if (!line.empty() && line[0] != '#') {
      return true;
    }
  }
  return false;
}

/// Removes what a recording without frames leaves, and nothing else.
void removeEmptyScan(const fs::path& folder) {
  std::error_code ignored;
  if (listsFrames(folder)) {
    return;
  }
  fs::remove(folder / "depth", ignored);  // only where they are empty
  fs::remove(folder / "rgb", ignored);
  if (fs::exists(folder / "depth", ignored) || fs::exists(folder / "rgb", ignored)) {
    return;
  }
  for (const char* file : {"depth.txt", "rgb.txt", "camera.json"}) {
    fs::remove(folder / file, ignored);
  }
  fs::remove(folder, ignored);
}

}  // namespace

Expected<ScanClaim> ScanClaim::take(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path lock = folder / kLock;
  const int file = ::open(lock.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (file < 0) {
    return fail(ErrorCode::FileUnwritable, folder.string());
  }
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
    ::close(file);
    return fail(ErrorCode::BadOption,
                folder.string() + " is being recorded just now; give another name");
  }
  ScanClaim claim(folder, file);
  if (listsFrames(folder)) {
    return fail(ErrorCode::BadOption,
                folder.string() +
                    " holds a scan already, perhaps of a recording that was interrupted; move it "
                    "away or give another name");
  }
  return claim;
}

ScanClaim::ScanClaim(ScanClaim&& other) noexcept
    : folder_(std::move(other.folder_)), file_(std::exchange(other.file_, -1)) {}

ScanClaim::~ScanClaim() {
  if (file_ >= 0) {
    std::error_code ignored;
    fs::remove(folder_ / kLock, ignored);
    removeEmptyScan(folder_);
    ::close(file_);
  }
}

}  // namespace tarsus
