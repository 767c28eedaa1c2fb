#include "reconstruction/base/atomic_file.h"

#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string contentOf(const fs::path& path) { return readTextFile(path).value_or("unreadable"); }

std::span<const std::byte> bytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST(AtomicFile, WritesAndReplacesWholeFiles) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  ASSERT_TRUE(writeTextAtomically(path, "first, and longer"));
  EXPECT_EQ(contentOf(path), "first, and longer");
  ASSERT_TRUE(writeTextAtomically(path, "second"));
  EXPECT_EQ(contentOf(path), "second");
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, KeepsEveryByte) {
  const TemporaryFolder folder;
  std::string bytes;
  for (int i = 0; i < 100000; ++i) {
    bytes.push_back(static_cast<char>((i * 31) % 256));
  }
  for (const Flush flush : {Flush::ToDisk, Flush::Later}) {
    ASSERT_TRUE(writeFileAtomically(folder.path() / "b.bin", bytesOf(bytes), flush));
    EXPECT_EQ(contentOf(folder.path() / "b.bin"), bytes);
  }
  ASSERT_TRUE(writeTextAtomically(folder.path() / "empty.txt", ""));
  EXPECT_EQ(contentOf(folder.path() / "empty.txt"), "");
}

TEST(AtomicFile, MakesMissingParentFolders) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x" / "y" / "a.txt";
  ASSERT_TRUE(writeTextAtomically(path, "text"));
  EXPECT_EQ(contentOf(path), "text");
}

TEST(AtomicFile, TemporaryFileKeepsTheExtension) {
  const TemporaryFolder folder;
  fs::path seen;
  ASSERT_TRUE(writeFileAtomically(folder.path() / "model.ply", [&](const fs::path& temporary) {
    seen = temporary;
    return writeBytes(temporary, bytesOf("ply"));
  }));
  EXPECT_EQ(seen.extension(), ".ply");
  EXPECT_EQ(seen.parent_path(), folder.path());
}

TEST(AtomicFile, GivingUpLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  ASSERT_TRUE(writeTextAtomically(path, "old"));
  const auto written = writeFileAtomically(path, [](const fs::path& temporary) -> Expected<void> {
    std::ofstream(temporary) << "half";
    return fail(ErrorCode::Cancelled, "by the test");
  });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(contentOf(path), "old");
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, AnExceptionLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  ASSERT_TRUE(writeTextAtomically(path, "old"));
  const auto throwing = [](const fs::path& temporary) -> Expected<void> {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("a bug");
  };
  EXPECT_THROW(static_cast<void>(writeFileAtomically(path, throwing)), std::runtime_error);
  EXPECT_EQ(contentOf(path), "old");
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, AFileThatWasNeverWrittenIsAnError) {
  const TemporaryFolder folder;
  const auto written = writeFileAtomically(folder.path() / "a.txt",
                                           [](const fs::path&) { return Expected<void>(); });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
}

TEST(AtomicFile, AFolderInTheWayIsAnError) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "a.txt" / "full");
  const auto written = writeTextAtomically(folder.path() / "a.txt", "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"a.txt"});
}

TEST(AtomicFile, AFileWhereAFolderShouldBeIsAnError) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeTextAtomically(folder.path() / "a", "text"));
  const auto written = writeTextAtomically(folder.path() / "a" / "b.txt", "text");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
  EXPECT_NE(written.error().detail.find(folder.path().string()), std::string::npos);
}

TEST(WriteBytes, AFullDeviceIsDiskFull) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "this system has no /dev/full";
  }
  const auto written = writeBytes("/dev/full", bytesOf("text"));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::DiskFull);
}

/// Runs `check` in a process of its own, so that its limits and mounts end with it.
/// @return the value that check returned
int inChild(int (*check)(const fs::path&), const fs::path& folder) {
  const pid_t child = fork();
  if (child == 0) {
    _exit(check(folder));
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100 + WTERMSIG(status);
}

constexpr int kNotAllowed = 77;

/// 0 where the failure was as it must be, else the number of what was wrong.
int checkFailure(const fs::path& folder, ErrorCode expected) {
  if (!writeTextAtomically(folder / "a.txt", "old")) {
    return 1;
  }
  const auto written = writeTextAtomically(folder / "a.txt", std::string(4 << 20, 'x'));
  if (written) {
    return 2;
  }
  if (written.error().code != expected) {
    return 3;
  }
  if (contentOf(folder / "a.txt") != "old") {
    return 4;
  }
  return namesIn(folder) == std::vector<std::string>{"a.txt"} ? 0 : 5;
}

TEST(AtomicFile, AFullDiskLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const int result = inChild(
      [](const fs::path& path) {
        const bool own_mounts =
            unshare(CLONE_NEWNS) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
        const bool mounted = own_mounts &&
                             mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                             mount("tmpfs", path.c_str(), "tmpfs", 0, "size=1m") == 0;
        return mounted ? checkFailure(path, ErrorCode::DiskFull) : kNotAllowed;
      },
      folder.path());
  if (result == kNotAllowed) {
    GTEST_SKIP() << "this user may not mount a small disk";
  }
  EXPECT_EQ(result, 0);
}

TEST(AtomicFile, AFileSizeLimitLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const int result = inChild(
      [](const fs::path& path) {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{.rlim_cur = 1 << 20, .rlim_max = 1 << 20};
        return setrlimit(RLIMIT_FSIZE, &limit) == 0 ? checkFailure(path, ErrorCode::FileUnwritable)
                                                    : kNotAllowed;
      },
      folder.path());
  EXPECT_EQ(result, 0);
}

TEST(ReadTextFile, AMissingFileAndAFolderAreTwoErrors) {
  const TemporaryFolder folder;
  EXPECT_EQ(readTextFile(folder.path() / "none").error().code, ErrorCode::FileMissing);
  EXPECT_EQ(readTextFile(folder.path()).error().code, ErrorCode::FileUnreadable);
}

}  // namespace
}  // namespace tarsus
