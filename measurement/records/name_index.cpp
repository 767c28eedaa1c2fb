#include "measurement/records/name_index.h"

#include <QString>
#include <QStringList>

#include <algorithm>
#include <iterator>

namespace tarsus {
namespace {

/// Letters that carry their stroke inside and are not parted by Unicode's decomposition.
QString withoutStroke(QChar letter) {
  switch (letter.unicode()) {
    case u'ø':
      return QStringLiteral("o");
    case u'ł':
      return QStringLiteral("l");
    case u'đ':
    case u'ð':
      return QStringLiteral("d");
    case u'ß':
      return QStringLiteral("ss");
    case u'æ':
      return QStringLiteral("ae");
    case u'œ':
      return QStringLiteral("oe");
    case u'ı':
      return QStringLiteral("i");
    default:
      return QString(letter);
  }
}

bool isWrittenWithoutSpaces(QChar letter) {
  switch (letter.script()) {
    case QChar::Script_Han:
    case QChar::Script_Hiragana:
    case QChar::Script_Katakana:
    case QChar::Script_Hangul:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::vector<std::string> searchWords(std::string_view text) {
  const QString folded = QString::fromUtf8(text.data(), static_cast<int>(text.size()))
                             .toCaseFolded()
                             .normalized(QString::NormalizationForm_KD);
  QString plain;
  for (const QChar letter : folded) {
    if (!letter.isMark()) {
      plain += letter.isLetterOrNumber() || letter.isSurrogate() ? withoutStroke(letter)
                                                                 : QStringLiteral(" ");
    }
  }
  // Composed again, so that a Korean syllable is one character.
  plain = plain.normalized(QString::NormalizationForm_KC);
  std::vector<std::string> words;
  const auto parts = plain.split(QLatin1Char(' '));
  for (const QString& part : parts) {
    for (int start = 0; start < part.size(); ++start) {
      if (start == 0 || isWrittenWithoutSpaces(part[start])) {
        words.push_back(part.mid(start).toStdString());
      }
    }
  }
  return words;
}

void NameIndex::set(const std::string& id, std::string_view text) {
  const std::int64_t version = ++versions_[id];
  for (std::string& word : searchWords(text)) {
    words_.push_back({.word = std::move(word), .id = id, .version = version});
  }
}

void NameIndex::clear() {
  for (Word& word : words_) {  // names leave the memory as far as it is ours
    std::ranges::fill(word.word, '\0');
  }
  words_.clear();
  words_.shrink_to_fit();
  versions_.clear();
  sorted_ = 0;
  seen_entry_ = 0;
}

void NameIndex::sort() {
  const auto middle = words_.begin() + static_cast<std::ptrdiff_t>(sorted_);
  std::sort(middle, words_.end());
  std::inplace_merge(words_.begin(), middle, words_.end());
  sorted_ = words_.size();
}

std::vector<std::string> NameIndex::find(std::string_view query, std::size_t most) {
  sort();
  std::vector<std::string> found;
  bool first = true;
  // A word written without spaces is looked for as a whole: its later parts come along unharmed.
  for (const std::string& wanted : searchWords(query)) {
    std::vector<std::string> ids;
    auto at = std::ranges::lower_bound(words_, wanted, {}, &Word::word);
    for (; at != words_.end() && at->word.starts_with(wanted); ++at) {
      if (versions_[at->id] == at->version) {
        ids.push_back(at->id);
      }
    }
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::vector<std::string> both;
    std::ranges::set_intersection(found, ids, std::back_inserter(both));
    found = first ? std::move(ids) : std::move(both);
    first = false;
  }
  found.resize(std::min(found.size(), most));
  return found;
}

}  // namespace tarsus
