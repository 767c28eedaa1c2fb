#include "reconstruction/capture/rig/rig.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <thread>
#include <vector>

namespace tarsus {
namespace {

/// The other end of a pseudo-terminal: a drive that answers as it is told.
class Drive {
 public:
  explicit Drive(std::function<std::string(const std::string&)> answer)
      : file_(posix_openpt(O_RDWR | O_NOCTTY)), answer_(std::move(answer)) {
    EXPECT_EQ(grantpt(file_), 0);
    EXPECT_EQ(unlockpt(file_), 0);
    device_ = ptsname(file_);
    held_ = ::open(device_.c_str(), O_RDWR | O_NOCTTY);  // or reading fails before anybody opens
    thread_ = std::thread([this] { serve(); });
  }
  ~Drive() {
    stop_ = true;
    const char wake = '\n';
    EXPECT_EQ(::write(held_, &wake, 1), 1);
    thread_.join();
    ::close(held_);
    ::close(file_);
  }
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;
  Drive(Drive&&) = delete;
  Drive& operator=(Drive&&) = delete;

  [[nodiscard]] const std::string& device() const { return device_; }

 private:
  void serve() {
    std::string line;
    char c = 0;
    while (!stop_ && ::read(file_, &c, 1) == 1) {
      if (c != '\n') {
        line += c;
        continue;
      }
      const std::string answer = stop_ ? std::string() : answer_(line);
      line.clear();
      if (!answer.empty() &&
          ::write(file_, answer.data(), answer.size()) != static_cast<ssize_t>(answer.size())) {
        return;
      }
    }
  }

  int file_;
  int held_ = -1;
  std::string device_;
  std::function<std::string(const std::string&)> answer_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

constexpr auto kSoon = std::chrono::milliseconds(200);

TEST(SerialRig, AsksAndUnderstands) {
  std::vector<std::string> asked;
  Drive drive([&](const std::string& line) -> std::string {
    asked.push_back(line);
    if (line == "HELLO") {
      return "TARSUS-RIG 1\r\n";
    }
    return line == "WHERE" ? (asked.size() == 3 ? "MOVING 12.5\n" : "AT -3\n") : "OK\n";
  });
  auto rig = openSerialRig(drive.device());
  ASSERT_TRUE(rig) << describe(rig.error());
  ASSERT_TRUE((*rig)->move(90.0, 4.5));
  const auto on_the_way = (*rig)->position();
  ASSERT_TRUE(on_the_way) << describe(on_the_way.error());
  EXPECT_EQ(on_the_way->place, 12.5);
  EXPECT_TRUE(on_the_way->moving);
  ASSERT_TRUE((*rig)->stop());
  const auto there = (*rig)->position();
  ASSERT_TRUE(there);
  EXPECT_EQ(there->place, -3.0);
  EXPECT_FALSE(there->moving);
  EXPECT_EQ(asked,
            (std::vector<std::string>{"HELLO", "MOVE 90.0000 4.5000", "WHERE", "STOP", "WHERE"}));
}

TEST(SerialRig, SaysWhatIsWrong) {
  for (const char* wrong :
       {"ERROR the arm is blocked\n", "AT x\n", "AT \n", "AT nan\n", "\n", ""}) {
    Drive drive([&](const std::string& line) -> std::string {
      return line == "HELLO" ? "TARSUS-RIG 1\n" : wrong;
    });
    auto rig = openSerialRig(drive.device(), kSoon);
    ASSERT_TRUE(rig) << wrong;
    const auto position = (*rig)->position();
    ASSERT_FALSE(position) << wrong;
    EXPECT_EQ(position.error().code, ErrorCode::RigFailed);
    EXPECT_NE(position.error().detail.find(drive.device()), std::string::npos);
  }
}

TEST(SerialRig, IsRefusedWhereNoneIs) {
  EXPECT_EQ(openSerialRig("/dev/nowhere").error().code, ErrorCode::RigFailed);
  EXPECT_EQ(openSerialRig("/dev/null").error().code, ErrorCode::RigFailed);
  Drive modem([](const std::string&) { return std::string("AT+OK\n"); });
  EXPECT_EQ(openSerialRig(modem.device(), kSoon).error().code, ErrorCode::RigFailed);
  Drive silent([](const std::string&) { return std::string(); });
  EXPECT_EQ(openSerialRig(silent.device(), kSoon).error().code, ErrorCode::RigFailed);
  Drive chatter([](const std::string&) { return std::string(1000, 'x'); });
  EXPECT_EQ(openSerialRig(chatter.device(), kSoon).error().code, ErrorCode::RigFailed);
}

TEST(SerialRig, RefusesImpossibleMoves) {
  Drive drive([](const std::string&) { return std::string("TARSUS-RIG 1\n"); });
  auto rig = openSerialRig(drive.device(), kSoon);
  ASSERT_TRUE(rig);
  EXPECT_EQ((*rig)->move(10.0, 0.0).error().code, ErrorCode::BadOption);
  EXPECT_EQ((*rig)->move(std::nan(""), 1.0).error().code, ErrorCode::BadOption);
}

TEST(SimulatedRig, MovesAtItsSpeedAndStops) {
  double now_s = 100.0;
  const auto rig = makeSimulatedRig(0.0, 180.0, [&] { return now_s; });
  ASSERT_TRUE(rig->move(90.0, 9.0));
  now_s += 5.0;
  EXPECT_DOUBLE_EQ(rig->position()->place, 45.0);
  EXPECT_TRUE(rig->position()->moving);
  ASSERT_TRUE(rig->stop());
  now_s += 5.0;
  EXPECT_DOUBLE_EQ(rig->position()->place, 45.0);
  EXPECT_FALSE(rig->position()->moving);
  ASSERT_TRUE(rig->move(0.0, 90.0));
  now_s += 60.0;
  EXPECT_DOUBLE_EQ(rig->position()->place, 0.0);
  EXPECT_FALSE(rig->position()->moving);
  EXPECT_EQ(rig->move(200.0, 9.0).error().code, ErrorCode::BadOption);
  EXPECT_EQ(rig->move(20.0, -9.0).error().code, ErrorCode::BadOption);
}

}  // namespace
}  // namespace tarsus
