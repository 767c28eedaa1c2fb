#include "measurement/report/page_canvas.h"

#include <QFontDatabase>
#include <QRawFont>

#include <algorithm>

namespace tarsus {
namespace {

const QString& textFamily() {
  static const QString family = QStringLiteral("Noto Sans");
  return family;
}

/// The file that Qt really opens for a request, since it substitutes silently.
QRawFont rawFont(const QString& family, bool bold) {
  QFont font(family);
  font.setBold(bold);
  font.setStyleStrategy(QFont::NoFontMerging);
  return QRawFont::fromFont(font);
}

}  // namespace

Expected<void> checkFonts() {
  for (const bool bold : {false, true}) {
    const QRawFont font = rawFont(textFamily(), bold);
    const bool right_weight = bold ? font.weight() >= QFont::Bold : font.weight() <= QFont::Medium;
    if (!font.isValid() || font.familyName() != textFamily() || !right_weight) {
      return fail(ErrorCode::FontMissing, bold ? "Noto Sans Bold" : "Noto Sans Regular");
    }
  }
  return {};
}

const QStringList& allowedFamilies() {
  // Noto Sans holds Latin, Greek and Cyrillic. All but the Chinese are of fonts-noto-core.
  static const QStringList families{textFamily(),
                                    QStringLiteral("Noto Sans Math"),
                                    QStringLiteral("Noto Sans CJK SC"),
                                    QStringLiteral("Noto Sans Arabic"),
                                    QStringLiteral("Noto Sans Hebrew"),
                                    QStringLiteral("Noto Sans Devanagari"),
                                    QStringLiteral("Noto Sans Thai"),
                                    QStringLiteral("Noto Sans Armenian"),
                                    QStringLiteral("Noto Sans Georgian"),
                                    QStringLiteral("Noto Sans Ethiopic"),
                                    QStringLiteral("Noto Sans Bengali"),
                                    QStringLiteral("Noto Sans Tamil"),
                                    QStringLiteral("Noto Sans Telugu"),
                                    QStringLiteral("Noto Sans Gujarati"),
                                    QStringLiteral("Noto Sans Gurmukhi"),
                                    QStringLiteral("Noto Sans Kannada"),
                                    QStringLiteral("Noto Sans Malayalam"),
                                    QStringLiteral("Noto Sans Sinhala"),
                                    QStringLiteral("Noto Sans Khmer"),
                                    QStringLiteral("Noto Sans Lao"),
                                    QStringLiteral("Noto Sans Myanmar")};
  return families;
}

std::vector<QRawFont> allowedFonts() {
  std::vector<QRawFont> fonts;
  for (const QString& family : allowedFamilies()) {
    QRawFont font = rawFont(family, false);
    if (font.isValid() && font.familyName() == family) {
      fonts.push_back(std::move(font));
    }
  }
  return fonts;
}

QString printable(const QString& text,
                  const std::vector<QRawFont>& fonts,
                  std::set<uint>* missing) {
  constexpr uint kBox = 0x25A1;
  const auto held = [&](uint letter) {
    return std::ranges::any_of(
        fonts, [&](const QRawFont& font) { return font.supportsCharacter(letter); });
  };
  const uint box = held(kBox) ? kBox : uint{'?'};
  QString result;
  for (const uint letter : text.toUcs4()) {
    const QChar::Category category = QChar::category(letter);
    uint printed = letter;
    if (category == QChar::Other_Control) {
      printed = ' ';
    } else if (!held(letter)) {
      if (category == QChar::Other_Format || category == QChar::Mark_NonSpacing) {
        continue;  // of an emoji, or of a letter that is itself a box
      }
      printed = box;
      if (missing != nullptr) {
        missing->insert(letter);
      }
    }
    result += QString::fromUcs4(&printed, 1);
  }
  return result;
}

}  // namespace tarsus
