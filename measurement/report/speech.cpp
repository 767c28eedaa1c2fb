#include "measurement/report/speech.h"

#include "measurement/report/numbers.h"
#include "measurement/report/phrases.h"

#include <QDate>
#include <QRegularExpression>

#include <cmath>

namespace tarsus {
namespace {

QString fromView(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

QString digitsOf(double value, int decimals, ReportLanguage language) {
  QString text = QString::fromStdString(fixedText(value, decimals));
  if (language != ReportLanguage::English && language != ReportLanguage::Chinese) {
    text.replace(QLatin1Char('.'), QLatin1Char(','));
  }
  return text;
}

}  // namespace

QString Speech::operator()(const Phrase& phrase) const { return fromView(phrase.in(language_)); }

QString Speech::number(double value, int decimals) const {
  return digitsOf(value, decimals, language_).replace(QLatin1Char('-'), QChar(0x2212));
}

QString Speech::signedNumber(double value, int decimals) const {
  const QString digits = digitsOf(std::abs(value), decimals, language_);
  const bool is_zero = digits == digitsOf(0.0, decimals, language_);
  return is_zero ? digits : (value < 0.0 ? QChar(0x2212) : QLatin1Char('+')) + digits;
}

QString Speech::interval(const Interval& interval, double factor, int decimals) const {
  if (interval.low < 0.0) {  // a dash between signs cannot be told from a minus
    const QString dots = QStringLiteral(u"\u00A0\u2026\u00A0");
    return signedNumber(interval.low * factor, decimals) + dots +
           signedNumber(interval.high * factor, decimals);
  }
  return number(interval.low * factor, decimals) + QChar(0x2013) +
         number(interval.high * factor, decimals);
}

QString Speech::percent(const QString& number) const {
  switch (language_) {
    case ReportLanguage::Chinese:
      return number + QLatin1Char('%');
    case ReportLanguage::French:
      return number + QChar(0x202F) + QLatin1Char('%');
    default:
      return number + QChar(QChar::Nbsp) + QLatin1Char('%');
  }
}

QString Speech::millilitres() const {
  return language_ == ReportLanguage::German ? QStringLiteral("ml") : QStringLiteral("mL");
}

QString Speech::date(const std::string& iso_8601) const {
  if (iso_8601.empty()) {
    return (*this)(phrase::kNotRecorded);
  }
  const QDate day = QDate::fromString(QString::fromStdString(iso_8601).left(10), Qt::ISODate);
  if (!day.isValid()) {
    return QString::fromStdString(iso_8601);
  }
  switch (language_) {
    case ReportLanguage::German:
      return day.toString(QStringLiteral("dd.MM.yyyy"));
    case ReportLanguage::French:
    case ReportLanguage::Spanish:
      return day.toString(QStringLiteral("dd/MM/yyyy"));
    case ReportLanguage::Chinese:
      return QStringLiteral(u"%1\u5E74%2\u6708%3\u65E5")
          .arg(day.year())
          .arg(day.month())
          .arg(day.day());
    default: {
      constexpr std::array kMonths{
          "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
      return QStringLiteral("%1 %2 %3")
          .arg(day.day())
          .arg(QLatin1String(kMonths[static_cast<std::size_t>(day.month() - 1)]))
          .arg(day.year());
    }
  }
}

QString Speech::dateTime(const std::string& iso_8601) const {
  const QString text = QString::fromStdString(iso_8601);
  if (text.size() < 16 || !QDate::fromString(text.left(10), Qt::ISODate).isValid()) {
    return date(iso_8601);
  }
  const QString zone = text.endsWith(QLatin1Char('Z')) ? QStringLiteral(" UTC") : QString();
  return date(iso_8601) + QLatin1Char(' ') + text.mid(11, 5) + zone;
}

QString Speech::term(std::string_view word) const {
  if (const Phrase* known = phrase::termNamed(word)) {
    return (*this)(*known);
  }
  return fromView(word).replace(QLatin1Char('_'), QLatin1Char(' '));
}

QString Speech::sentence(const std::string& english) const {
  const QString text = QString::fromStdString(english);
  const std::optional<phrase::KnownSentence> known = phrase::sentenceNamed(text);
  if (!known) {
    return phrase::termNamed(english) != nullptr ? term(english) : text;
  }
  QString said = (*this)(*known->phrase);
  for (int i = 0; i < known->values.size(); ++i) {
    QString value = known->values[i];
    static const QRegularExpression kNumber(QStringLiteral("^-?[0-9]+\\.[0-9]+$"));
    if (value.contains(kNumber)) {
      value = number(value.toDouble(), value.size() - value.indexOf(QLatin1Char('.')) - 1);
    } else {
      value = sentence(value.toStdString());
    }
    said.replace(QLatin1Char('%') + QString::number(i + 1), value);
  }
  return said;
}

QString Speech::listed(const QStringList& parts) const {
  if (parts.size() < 2) {
    return parts.join(QString());
  }
  const QStringList first = parts.mid(0, parts.size() - 1);
  const QString comma =
      language_ == ReportLanguage::Chinese ? QString(QChar(0x3001)) : QStringLiteral(", ");
  return (*this)(phrase::kAnd, first.join(comma), parts.last());
}

QString Speech::entered(const std::string& text) const {
  return text.empty() ? (*this)(phrase::kNotRecorded) : QString::fromStdString(text);
}

QString Speech::gap() const {
  return language_ == ReportLanguage::Chinese ? QString() : QStringLiteral(" ");
}

QString Speech::semicolon() const {
  switch (language_) {
    case ReportLanguage::Chinese:
      return QString(QChar(0xFF1B));
    case ReportLanguage::French:
      return QString(QChar(0x202F)) + QStringLiteral("; ");
    default:
      return QStringLiteral("; ");
  }
}

QString Speech::colon() const {
  switch (language_) {
    case ReportLanguage::Chinese:
      return QString(QChar(0xFF1A));
    case ReportLanguage::French:
      return QString(QChar(0x202F)) + QStringLiteral(": ");
    default:
      return QStringLiteral(": ");
  }
}

}  // namespace tarsus
