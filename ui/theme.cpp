#include "ui/theme.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

double linear(double channel) {
  return channel <= 0.03928 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

double luminance(const QColor& color) {
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) +
         0.0722 * linear(color.blueF());
}

const QString& sheet() {
  static const QString text = QStringLiteral(R"(
QWidget#window, QWidget#page { background: @background; }
QWidget#header, QWidget#status { background: @surface; }
QWidget#header { border-bottom: 1px solid @line; }
QWidget#status { border-top: 1px solid @line; }
QFrame[role="card"] { background: @surface; border: none; border-radius: 6px; }
QFrame[role="well"] { background: @sunk; border: none; border-radius: 6px; }
QFrame[role="line"] { background: @line; border: none; }
QFrame[tone="danger"] { background: @danger_weak; border: none; border-radius: 6px; }
QFrame[tone="danger"] QLabel { color: @danger_text; }
QLabel { color: @text; background: transparent; }
QLabel[tone="secondary"] { color: @text2; }
QLabel[chip="good"] { background: @accent_weak; color: @accent_text; border-radius: 6px; padding: 4px 10px; }
QLabel[chip="bad"] { background: @danger_weak; color: @danger_text; border-radius: 6px; padding: 4px 10px; }
QLabel[chip="unknown"] { background: @warning_weak; color: @warning_text; border-radius: 6px; padding: 4px 10px; }
QPushButton { background: @surface; color: @text; border: 1px solid @edge; border-radius: 6px; padding: 0 16px; min-height: 38px; }
QPushButton:hover { background: @sunk; }
QPushButton:focus { border: 2px solid @accent; }
QPushButton[role="primary"] { background: @accent; color: @on_accent; border: 1px solid @accent; }
QPushButton[role="primary"]:hover { background: @accent_text; }
QPushButton[role="primary"]:focus { border: 2px solid @text; }
QToolButton { background: @surface; color: @text; border: 1px solid @edge; border-radius: 6px; padding: 0 12px; min-height: 38px; }
QToolButton:disabled { color: @text2; background: @sunk; border: 1px solid @line; }
QToolButton:hover { background: @sunk; }
QToolButton:focus { border: 2px solid @accent; }
QToolButton:checked { background: @accent_weak; color: @accent_text; border: 1px solid @accent; }
QScrollArea, QScrollArea > QWidget > QWidget { background: transparent; border: none; }
QToolTip { background: @text; color: @surface; border: none; padding: 4px; }
)");
  return text;
}

}  // namespace

Theme Theme::light() {
  Theme theme;
  theme.background = QColor(0xF6, 0xF7, 0xF9);
  theme.surface = QColor(0xFF, 0xFF, 0xFF);
  theme.sunk = QColor(0xED, 0xF0, 0xF3);
  theme.text = QColor(0x1B, 0x24, 0x30);
  theme.text_secondary = QColor(0x5B, 0x66, 0x75);
  theme.accent = QColor(0x0B, 0x7A, 0x75);
  theme.on_accent = QColor(0xFF, 0xFF, 0xFF);
  theme.accent_text = QColor(0x0B, 0x6E, 0x6A);
  theme.accent_weak = QColor(0xE1, 0xF0, 0xEF);
  theme.danger = QColor(0xB3, 0x26, 0x1E);
  theme.danger_text = QColor(0xA3, 0x21, 0x1A);
  theme.danger_weak = QColor(0xFB, 0xEA, 0xE8);
  theme.warning_text = QColor(0x85, 0x54, 0x08);
  theme.warning_weak = QColor(0xFB, 0xF2, 0xE0);
  theme.line = QColor(0xDD, 0xE2, 0xE8);
  theme.control_edge = QColor(0x7F, 0x8B, 0x99);
  theme.view = QColor(0xE7, 0xEB, 0xEF);
  return theme;
}

QPalette Theme::palette() const {
  QPalette result;
  result.setColor(QPalette::Window, background);
  result.setColor(QPalette::Base, surface);
  result.setColor(QPalette::AlternateBase, sunk);
  result.setColor(QPalette::Button, surface);
  result.setColor(QPalette::WindowText, text);
  result.setColor(QPalette::Text, text);
  result.setColor(QPalette::ButtonText, text);
  result.setColor(QPalette::Highlight, accent);
  result.setColor(QPalette::HighlightedText, on_accent);
  return result;
}

QString Theme::styleSheet() const {
  QString filled = sheet();
  // Longer names first, so that none is the beginning of one still to come.
  const std::pair<const char*, QColor> tokens[] = {
      {"@background", background},
      {"@surface", surface},
      {"@sunk", sunk},
      {"@accent_text", accent_text},
      {"@accent_weak", accent_weak},
      {"@on_accent", on_accent},
      {"@accent", accent},
      {"@danger_text", danger_text},
      {"@danger_weak", danger_weak},
      {"@warning_text", warning_text},
      {"@warning_weak", warning_weak},
      {"@text2", text_secondary},
      {"@text", text},
      {"@line", line},
      {"@edge", control_edge},
  };
  for (const auto& [name, color] : tokens) {
    filled.replace(QLatin1String(name), color.name());
  }
  return filled;
}

QFont themeFont(TypeRole role) {
  QFont font(QStringLiteral("Noto Sans"));
  switch (role) {
    case TypeRole::Small:
      font.setPixelSize(12);
      break;
    case TypeRole::Label:
      font.setPixelSize(13);
      font.setWeight(QFont::DemiBold);
      break;
    case TypeRole::Base:
      font.setPixelSize(14);
      break;
    case TypeRole::Heading:
      font.setPixelSize(18);
      font.setWeight(QFont::DemiBold);
      break;
    case TypeRole::Title:
      font.setPixelSize(24);
      font.setWeight(QFont::DemiBold);
      break;
  }
  return font;
}

double contrast(const QColor& a, const QColor& b) {
  const double one = luminance(a);
  const double other = luminance(b);
  return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

}  // namespace tarsus
