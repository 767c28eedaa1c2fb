#pragma once

#include "measurement/report/visit_content.h"
#include "measurement/wound/measure.h"

#include <QString>
#include <QStringList>

#include <array>
#include <string_view>

namespace tarsus {

/// One printed text in all languages. Which is missing, empty or lacks a placeholder that the
/// English one has, does not compile.
class Phrase {
 public:
  consteval Phrase(std::string_view english,
                   std::string_view german,
                   std::string_view french,
                   std::string_view spanish,
                   std::string_view chinese)
      : text_{english, german, french, spanish, chinese} {
    for (const std::string_view text : text_) {
      if (text.empty() || placeholders(text) != placeholders(english)) {
        throw "a phrase must be said in every language, with the same placeholders";
      }
    }
  }
  [[nodiscard]] constexpr std::string_view in(ReportLanguage language) const {
    return text_[static_cast<std::size_t>(language)];
  }

 private:
  static constexpr int placeholders(std::string_view text) {
    int found = 0;  // one bit for each of %1 to %9
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
      if (text[i] == '%' && text[i + 1] >= '1' && text[i + 1] <= '9') {
        found |= 1 << (text[i + 1] - '0');
      }
    }
    return found;
  }

  std::array<std::string_view, 5> text_;
};

/// Says things in the report's language: phrases, numbers, units, dates (report design section 4).
class Speech {
 public:
  explicit Speech(ReportLanguage language) : language_(language) {}

  [[nodiscard]] ReportLanguage language() const { return language_; }
  [[nodiscard]] QString operator()(const Phrase& phrase) const;
  template <typename... Values>
  [[nodiscard]] QString operator()(const Phrase& phrase, const Values&... values) const {
    return (*this)(phrase).arg(values...);
  }

  /// With the language's decimal mark; rounded once, half away from zero.
  [[nodiscard]] QString number(double value, int decimals) const;
  /// The same with its sign, a true minus, also for a plus.
  [[nodiscard]] QString signedNumber(double value, int decimals) const;
  [[nodiscard]] QString interval(const Interval& interval, double factor, int decimals) const;
  /// A number already in print, with its sign of per cent.
  [[nodiscard]] QString percent(const QString& number) const;
  [[nodiscard]] QString millilitres() const;
  /// The day of an ISO 8601 time; what is none stands as it is; empty: "not recorded".
  [[nodiscard]] QString date(const std::string& iso_8601) const;
  [[nodiscard]] QString dateTime(const std::string& iso_8601) const;
  /// A word of the record or of a score, where it is known; else the word itself, readable.
  [[nodiscard]] QString term(std::string_view word) const;
  /// A sentence of the measurement (a reason, a warning), where it is known; else as it stands.
  [[nodiscard]] QString sentence(const std::string& english) const;
  /// "a, b and c".
  [[nodiscard]] QString listed(const QStringList& parts) const;
  /// What a person typed; empty: "not recorded".
  [[nodiscard]] QString entered(const std::string& text) const;
  /// Between two sentences.
  [[nodiscard]] QString gap() const;
  /// Before what explains: ": ", in French with its space, in Chinese the full-width mark.
  [[nodiscard]] QString colon() const;
  /// Between two parts of a list that themselves hold commas.
  [[nodiscard]] QString semicolon() const;

 private:
  ReportLanguage language_;
};

}  // namespace tarsus
