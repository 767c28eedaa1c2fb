#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace tarsus {

/// Walks over text in memory by lines or words; never past its end, never by the locale.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool atEnd() const { return position_ >= text_.size(); }
  [[nodiscard]] std::size_t position() const { return position_; }

  /// The rest of this line without its end (\n or \r\n).
  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view result = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    if (!result.empty() && result.back() == '\r') {
      result.remove_suffix(1);
    }
    return result;
  }

  /// The next word, over line ends too; empty at the end.
  std::string_view word() {
    while (!atEnd() && isBlank(text_[position_])) {
      ++position_;
    }
    const std::size_t start = position_;
    while (!atEnd() && !isBlank(text_[position_])) {
      ++position_;
    }
    return text_.substr(start, position_ - start);
  }

  /// The next word as a number ("nan" and "inf" among them); empty if it is none.
  std::optional<double> number() { return parsed<double>(word()); }
  std::optional<std::uint64_t> count() { return parsed<std::uint64_t>(word()); }

  template <typename T>
  [[nodiscard]] static std::optional<T> parsed(std::string_view word) {
    if (!word.empty() && word.front() == '+') {
      word.remove_prefix(1);
    }
    T value{};
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    const bool whole = stop == end && error == std::errc() && !word.empty();
    return whole ? std::optional<T>(value) : std::nullopt;
  }

 private:
  static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view text_;
  std::size_t position_ = 0;
};

}  // namespace tarsus
