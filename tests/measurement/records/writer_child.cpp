#include "tests/measurement/records/writer_child.h"

#include "tests/measurement/records/record_test.h"
#include "tests/measurement/records/records_main.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <sstream>

namespace tarsus {
namespace {

constexpr std::int64_t kTime = 1767225600000;

/// Adds visits with a long note each and says so only once they are confirmed.
int writeForever(const std::vector<std::string>& arguments) {
  StorePlace place{.folder = arguments.at(0)};
  if (!arguments.at(2).empty()) {
    place.postgres = PostgresAddress{
        .host = arguments.at(2), .database = arguments.at(3), .user = arguments.at(4)};
  }
  Store store = must(Store::open(place, testEnvironment([] { return kTime; }, "child")));
  must(signIn(store, "nils", kPassword));
  for (int i = 0;; ++i) {
    const std::string text = std::to_string(::getpid()) + ":" + std::to_string(i);
    const Visit visit =
        must(addVisit(store, arguments.at(1), sampleVisit(kTime, text + std::string(3000, '.'))));
    const std::string line = visit.id + " " + text + "\n";
    if (::write(STDOUT_FILENO, line.data(), line.size()) < 0) {
      return 1;
    }
  }
}

const int kRegistered = registerChild(writeForever);

}  // namespace

WriterChild::WriterChild(const StorePlace& place, const std::string& wound) {
  EXPECT_EQ(kRegistered, 0);
  const PostgresAddress address = place.postgres.value_or(PostgresAddress{});
  std::vector<std::string> words{"test",
                                 "--child",
                                 place.folder.string(),
                                 wound,
                                 address.host,
                                 address.database,
                                 address.user};
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  int ends[2] = {-1, -1};
  EXPECT_EQ(::pipe(ends), 0);
  child_ = ::fork();
  if (child_ == 0) {
    ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    ::execv("/proc/self/exe", pointers.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  pipe_ = ends[0];
}

WriterChild::~WriterChild() {
  if (pipe_ >= 0) {
    ::close(pipe_);
  }
}

std::vector<std::string> WriterChild::killAfter(unsigned wait_us) {
  std::string said;
  char letter = '\0';
  while (said.find('\n') == std::string::npos && ::read(pipe_, &letter, 1) == 1) {
    said.push_back(letter);
  }
  ::usleep(wait_us);
  ::kill(child_, SIGKILL);
  while (::read(pipe_, &letter, 1) == 1) {
    said.push_back(letter);
  }
  ::waitpid(child_, nullptr, 0);
  said.resize(said.rfind('\n') == std::string::npos ? 0 : said.rfind('\n') + 1);
  std::vector<std::string> lines;
  std::istringstream stream(said);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

}  // namespace tarsus
