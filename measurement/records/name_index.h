#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tarsus {

/// Words without case and accents: "Müller-Łuczak" is "muller", "luczak". Where words are not
/// parted by spaces (Chinese, Japanese, Korean) one begins at each character.
[[nodiscard]] std::vector<std::string> searchWords(std::string_view text);

/// Who has a word that begins so; kept in memory only, as names lie encrypted on the disk.
class NameIndex {
 public:
  /// What is found under this id from now on; an empty text: nothing.
  void set(const std::string& id, std::string_view text);
  void clear();
  /// Ids of which each word of the query begins a word, sorted, at most `most`.
  [[nodiscard]] std::vector<std::string> find(std::string_view query, std::size_t most);

  /// The last audit entry that is in the index.
  [[nodiscard]] std::int64_t seenEntry() const { return seen_entry_; }
  void setSeenEntry(std::int64_t entry) { seen_entry_ = entry; }

 private:
  void sort();
  struct Word {
    std::string word;
    std::string id;
    std::int64_t version;  ///< words of an older text of the same id are passed over
    auto operator<=>(const Word&) const = default;
  };
  std::vector<Word> words_;
  std::int64_t seen_entry_ = 0;
  std::size_t sorted_ = 0;  ///< the words after that were added since
  std::unordered_map<std::string, std::int64_t> versions_;
};

}  // namespace tarsus
