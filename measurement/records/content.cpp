#include "measurement/records/content.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>

namespace tarsus {

using nlohmann::json;

json ContentReader::value(const char* key) const {
  const json& content = revision_->content;
  return content.is_object() && content.contains(key) ? content.at(key) : json();
}

std::string ContentReader::text(const char* key) const {
  const json found = value(key);
  return found.is_string() ? found.get<std::string>() : std::string();
}

std::int64_t ContentReader::integer(const char* key) const {
  const json found = value(key);
  return found.is_number_integer() ? found.get<std::int64_t>() : 0;
}

bool ContentReader::flag(const char* key) const {
  const json found = value(key);
  return found.is_boolean() && found.get<bool>();
}

std::vector<std::string> ContentReader::texts(const char* key) const {
  std::vector<std::string> texts;
  for (const json& item : value(key)) {
    if (item.is_string()) {
      texts.push_back(item.get<std::string>());
    }
  }
  return texts;
}

std::vector<int> ContentReader::integers(const char* key) const {
  std::vector<int> integers;
  for (const json& item : value(key)) {
    if (item.is_number_integer()) {
      integers.push_back(item.get<int>());
    }
  }
  return integers;
}

tl::unexpected<Error> ContentReader::damaged(const char* key) const {
  return fail(ErrorCode::StoreDamaged,
              "record " + revision_->record + ": its " + key + " cannot be read");
}

bool isBlank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n\v\f") == std::string_view::npos;
}

bool isName(std::string_view text) {
  constexpr std::size_t kLongest = 300;
  return !isBlank(text) && text.size() <= kLongest && std::ranges::none_of(text, [](char letter) {
    const auto code = static_cast<unsigned char>(letter);
    return code < 0x20 || code == 0x7f;
  });
}

std::string dayOf(std::int64_t at_ms) {
  const std::chrono::sys_time<std::chrono::milliseconds> at{std::chrono::milliseconds(at_ms)};
  const std::chrono::year_month_day day(std::chrono::floor<std::chrono::days>(at));
  std::array<char, 48> text{};
  std::snprintf(text.data(),
                text.size(),
                "%04d-%02u-%02u",
                static_cast<int>(day.year()),
                static_cast<unsigned>(day.month()),
                static_cast<unsigned>(day.day()));
  return text.data();
}

bool isDate(std::string_view text) {
  constexpr std::size_t kLength = 10;
  if (text.size() != kLength || text[4] != '-' || text[7] != '-') {
    return false;
  }
  const auto number = [&](std::size_t at, std::size_t size) {
    int value = -1;
    const char* const end = text.data() + at + size;
    const auto [stop, error] = std::from_chars(text.data() + at, end, value);
    return error == std::errc() && stop == end ? value : -1;
  };
  const int year = number(0, 4);
  const int month = number(5, 2);
  const int day = number(8, 2);
  return year > 0 && month > 0 && day > 0 &&
         std::chrono::year_month_day(std::chrono::year(year),
                                     std::chrono::month(static_cast<unsigned>(month)),
                                     std::chrono::day(static_cast<unsigned>(day)))
             .ok();
}

}  // namespace tarsus
