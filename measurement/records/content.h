#pragma once

#include "measurement/records/revisions.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tarsus {

/// Fields of a revision's content. A field of another type reads as empty: what a later version of
/// the program wrote differently must not stop an older one from showing the rest.
class ContentReader {
 public:
  explicit ContentReader(const Revision& revision) : revision_(&revision) {}
  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] std::int64_t integer(const char* key) const;
  [[nodiscard]] bool flag(const char* key) const;
  [[nodiscard]] nlohmann::json value(const char* key) const;  ///< null where there is none
  [[nodiscard]] std::vector<std::string> texts(const char* key) const;
  [[nodiscard]] std::vector<int> integers(const char* key) const;
  /// For a field without which the record means nothing.
  [[nodiscard]] tl::unexpected<Error> damaged(const char* key) const;

 private:
  const Revision* revision_;
};

/// Nothing but spaces.
[[nodiscard]] bool isBlank(std::string_view text);
/// A name as people write it: something to read, no line breaks or other control characters, and
/// not endless.
[[nodiscard]] bool isName(std::string_view text);
/// The day of a time, written 2026-03-01, UTC.
[[nodiscard]] std::string dayOf(std::int64_t at_ms);

/// A date of the calendar, written 2026-03-01.
[[nodiscard]] bool isDate(std::string_view text);

/// The typed record of each revision, or the first error.
template <typename Record>
[[nodiscard]] Expected<std::vector<Record>> readEach(
    const Expected<std::vector<Revision>>& revisions, Expected<Record> (*read)(const Revision&)) {
  if (!revisions) {
    return tl::unexpected(revisions.error());
  }
  std::vector<Record> records;
  records.reserve(revisions->size());
  for (const Revision& revision : *revisions) {
    auto record = read(revision);
    if (!record) {
      return tl::unexpected(record.error());
    }
    records.push_back(std::move(*record));
  }
  return records;
}

}  // namespace tarsus
