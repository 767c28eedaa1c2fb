#include "measurement/report/page_canvas.h"

#include <QFontDatabase>
#include <QRawFont>

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

std::vector<QRawFont> allowedFonts() {
  std::vector<QRawFont> fonts;
  for (const QString& family :
       {textFamily(), QStringLiteral("Noto Sans Math"), QStringLiteral("Noto Sans CJK SC")}) {
    QRawFont font = rawFont(family, false);
    if (font.isValid() && font.familyName() == family) {
      fonts.push_back(std::move(font));
    }
  }
  return fonts;
}

QString printable(const QString& text, const std::vector<QRawFont>& fonts) {
  QString result;
  for (const uint letter : text.toUcs4()) {
    bool held = false;
    for (const QRawFont& font : fonts) {
      held = held || font.supportsCharacter(letter);
    }
    const uint printed = held ? letter : uint{'?'};
    result += QString::fromUcs4(&printed, 1);
  }
  return result;
}

}  // namespace tarsus
