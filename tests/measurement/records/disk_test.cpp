#include "measurement/records/check.h"
#include "measurement/records/sign_in.h"
#include "tests/measurement/records/record_test.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

StoreEnvironment fixedTime() {
  return testEnvironment([] { return std::int64_t{1767225600000}; }, "ward 1");
}

/// A limit on the size of files stands for the full disk that a test cannot make without being
/// root: the write fails in the same place.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(FullDisk, GivesASentenceAndKeepsWhatWasConfirmed) {
  const TemporaryFolder folder;
  const StorePlace place{.folder = folder.path() / "store"};
  std::size_t confirmed = 0;
  {
    Store store = must(Store::open(place, fixedTime()));
    must(firstRun(store, "anna", kPassword));
    must(addUser(store, "nils", Role::Nurse, kPassword));
    must(signIn(store, "nils", kPassword));
    const FileSizeLimit limit(600000);
    Expected<Patient> patient = must(addPatient(store, named("Berg", "Ida")));
    for (int i = 0; patient && i < 2000; ++i) {
      ++confirmed;
      patient = addPatient(store, named("Berg", std::string(250, 'x')));
    }
    ASSERT_FALSE(patient) << "the limit was never met";
    EXPECT_TRUE(patient.error().code == ErrorCode::DiskFull ||
                patient.error().code == ErrorCode::FileUnwritable)
        << describe(patient.error());
    const auto put = store.files().put(store.vault(), place.folder / "records.sqlite");
    ASSERT_TRUE(put.has_value() || put.error().code == ErrorCode::FileUnwritable ||
                put.error().code == ErrorCode::DiskFull);
  }
  Store store = must(Store::open(place, fixedTime()));
  must(signIn(store, "nils", kPassword));
  EXPECT_EQ(must(searchPatients(store, "berg", 10000)).size(), confirmed);
  EXPECT_TRUE(must(checkStore(store)).findings.empty());
}

/// Rights do not hold root back, so root becomes somebody else in a child process.
int inChildWithoutRights(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) {
      ::_exit(100);
    }
    ::_exit(work());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ReadOnlyFolder, GivesASentence) {
  const TemporaryFolder folder;
  fs::permissions(folder.path(),
                  fs::perms::owner_all | fs::perms::others_read | fs::perms::others_exec |
                      fs::perms::group_read);
  const StorePlace place{.folder = folder.path() / "store"};
  {
    Store store = must(Store::open(place, fixedTime()));
    must(firstRun(store, "anna", kPassword));
  }
  for (const auto& file : fs::directory_iterator(place.folder)) {
    fs::permissions(file.path(), fs::perms::owner_read | fs::perms::others_read);
  }
  fs::permissions(place.folder,
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                      fs::perms::others_exec);
  const int outcome = inChildWithoutRights([&] {
    auto store = Store::open(place, fixedTime());
    const auto signed_in =
        store.and_then([](Store& open) { return signIn(open, "anna", kPassword); });
    if (signed_in) {
      return 1;
    }
    return signed_in.error().code == ErrorCode::FileUnwritable ? 0 : 2;
  });
  fs::permissions(place.folder, fs::perms::owner_all);
  EXPECT_EQ(outcome, 0);
}

TEST(UnreachableFolder, GivesASentence) {
  const TemporaryFolder folder;
  const int outcome = inChildWithoutRights([&] {
    const auto store = Store::open({.folder = "/proc/no/such/place"}, fixedTime());
    return !store && store.error().code == ErrorCode::FileUnwritable ? 0 : 1;
  });
  EXPECT_EQ(outcome, 0);
}

}  // namespace
}  // namespace tarsus
