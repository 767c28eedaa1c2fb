#include "reconstruction/capture/rig/rig.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace tarsus {
namespace {

constexpr std::string_view kGreeting = "TARSUS-RIG 1";
constexpr std::size_t kLongestLine = 200;

/// A line of text at a time over a device that may fall silent.
class SerialLine {
 public:
  SerialLine(int file, std::string device, std::chrono::milliseconds answer)
      : file_(file), device_(std::move(device)), answer_(answer) {}
  ~SerialLine() { ::close(file_); }
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;
  SerialLine(SerialLine&&) = delete;
  SerialLine& operator=(SerialLine&&) = delete;

  /// Sends a line and gives the answer, without its end.
  Expected<std::string> ask(const std::string& line) {
    ::tcflush(file_, TCIFLUSH);  // the answer to an earlier question that came too late
    waiting_.clear();
    const std::string whole = line + "\n";
    if (::write(file_, whole.data(), whole.size()) != static_cast<ssize_t>(whole.size())) {
      return failed("cannot be written to: " + std::string(std::strerror(errno)));
    }
    return read(line);
  }

  [[nodiscard]] tl::unexpected<Error> failed(const std::string& why) const {
    return fail(ErrorCode::RigFailed, device_ + " " + why);
  }

 private:
  Expected<std::string> read(const std::string& question) {
    const auto until = std::chrono::steady_clock::now() + answer_;
    while (true) {
      if (const auto end = waiting_.find('\n'); end != std::string::npos) {
        std::string line = waiting_.substr(0, end);
        waiting_.erase(0, end + 1);
        if (!line.empty() && line.back() == '\r') {
          line.pop_back();
        }
        return line;
      }
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          until - std::chrono::steady_clock::now());
      pollfd ready{.fd = file_, .events = POLLIN, .revents = 0};
      if (left.count() <= 0 || ::poll(&ready, 1, static_cast<int>(left.count())) <= 0) {
        return failed("does not answer to " + question);
      }
      std::array<char, 64> bytes{};
      const ssize_t got = ::read(file_, bytes.data(), bytes.size());
      if (got <= 0 || waiting_.size() > kLongestLine) {
        return failed(got <= 0 ? "was unplugged" : "sends no lines of text");
      }
      waiting_.append(bytes.data(), static_cast<std::size_t>(got));
    }
  }

  int file_;
  std::string device_;
  std::chrono::milliseconds answer_;
  std::string waiting_;
};

/// The number, if it is all of the text.
std::optional<double> numberIn(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

class SerialRig final : public Rig {
 public:
  explicit SerialRig(std::unique_ptr<SerialLine> line) : line_(std::move(line)) {}

  Expected<void> greet() {
    const auto answer = line_->ask("HELLO");
    if (!answer) {
      return tl::unexpected(answer.error());
    }
    return *answer == kGreeting ? Expected<void>()
                                : line_->failed("is no Tarsus rig: it says \"" + *answer + "\"");
  }

  Expected<void> move(double place, double speed) override {
    if (!std::isfinite(place) || !std::isfinite(speed) || speed <= 0.0) {
      return fail(ErrorCode::BadOption, "a rig moves to a number, at a speed greater than 0");
    }
    std::array<char, 80> text{};
    std::snprintf(text.data(), text.size(), "MOVE %.4f %.4f", place, speed);
    return expectOk(text.data());
  }

  Expected<RigPosition> position() override {
    const auto answer = line_->ask("WHERE");
    if (!answer) {
      return tl::unexpected(answer.error());
    }
    const std::string_view text = *answer;
    for (const auto& [word, moving] : {std::pair("AT ", false), std::pair("MOVING ", true)}) {
      if (text.starts_with(word)) {
        const auto place = numberIn(text.substr(std::strlen(word)));
        if (place) {
          return RigPosition{.place = *place, .moving = moving};
        }
      }
    }
    return refused("WHERE", *answer);
  }

  Expected<void> stop() override { return expectOk("STOP"); }

 private:
  Expected<void> expectOk(const std::string& question) {
    const auto answer = line_->ask(question);
    if (!answer) {
      return tl::unexpected(answer.error());
    }
    return *answer == "OK" ? Expected<void>() : refused(question, *answer);
  }

  [[nodiscard]] tl::unexpected<Error> refused(const std::string& question,
                                              const std::string& answer) const {
    return line_->failed("answers to " + question + ": \"" + answer + "\"");
  }

  std::unique_ptr<SerialLine> line_;
};

/// Raw bytes at 115200 baud, 8N1.
bool setUp(int file) {
  termios settings{};
  if (::tcgetattr(file, &settings) != 0) {
    return false;
  }
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  return ::cfsetspeed(&settings, B115200) == 0 && ::tcsetattr(file, TCSANOW, &settings) == 0;
}

}  // namespace

Expected<std::unique_ptr<Rig>> openSerialRig(const std::string& device,
                                             std::chrono::milliseconds answer) {
  const int file = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (file < 0) {
    return fail(ErrorCode::RigFailed, device + ": " + std::strerror(errno));
  }
  auto line = std::make_unique<SerialLine>(file, device, answer);
  if (!setUp(file)) {
    return line->failed("is no serial line");
  }
  auto rig = std::make_unique<SerialRig>(std::move(line));
  if (auto greeted = rig->greet(); !greeted) {
    return tl::unexpected(greeted.error());
  }
  return rig;
}

}  // namespace tarsus
