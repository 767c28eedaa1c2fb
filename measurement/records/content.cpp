#include "measurement/records/content.h"

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
