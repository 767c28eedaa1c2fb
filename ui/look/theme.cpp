#include "ui/look/theme.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

double linear(double channel) {
  return channel <= 0.03928 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

/// Not QColor(QRgb) itself: a literal 0 would be taken for a pointer to a name.
QColor hex(QRgb rgb) { return QColor(rgb); }

double luminance(const QColor& color) {
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) +
         0.0722 * linear(color.blueF());
}

}  // namespace

Theme Theme::light() {
  return {.background = hex(0xF6F7F9),
          .surface = hex(0xFFFFFF),
          .sunk = hex(0xEDF0F3),
          .text = hex(0x1B2430),
          .text_secondary = hex(0x5B6675),
          .accent = hex(0x0B7A75),
          .on_accent = hex(0xFFFFFF),
          .accent_text = hex(0x0B6E6A),
          .accent_weak = hex(0xE1F0EF),
          .warning = hex(0xB7791F),
          .warning_text = hex(0x855408),
          .warning_weak = hex(0xFBF2E0),
          .danger = hex(0xB3261E),
          .danger_text = hex(0xA3211A),
          .danger_weak = hex(0xFBEAE8),
          .line = hex(0xDDE2E8),
          .control_edge = hex(0x7F8B99),
          .view = hex(0xE7EBEF)};
}

Theme Theme::dark() {
  return {.background = hex(0x12181F),
          .surface = hex(0x1B232C),
          .sunk = hex(0x151C24),
          .text = hex(0xE8ECF1),
          .text_secondary = hex(0xA7B2BF),
          .accent = hex(0x4DB6AC),
          .on_accent = hex(0x06201E),
          .accent_text = hex(0x6FCBC2),
          .accent_weak = hex(0x17393A),
          .warning = hex(0xE5B454),
          .warning_text = hex(0xEBC172),
          .warning_weak = hex(0x352B17),
          .danger = hex(0xFF8A80),
          .danger_text = hex(0xFF9B92),
          .danger_weak = hex(0x3A2020),
          .line = hex(0x303B47),
          .control_edge = hex(0x7C8896),
          .view = hex(0x0C1116)};
}

Theme Theme::highContrast() {
  return {.background = hex(0x000000),
          .surface = hex(0x000000),
          .sunk = hex(0x000000),
          .text = hex(0xFFFFFF),
          .text_secondary = hex(0xFFFFFF),
          .accent = hex(0x5CF2E6),
          .on_accent = hex(0x000000),
          .accent_text = hex(0x5CF2E6),
          .accent_weak = hex(0x00332F),
          .warning = hex(0xFFD54A),
          .warning_text = hex(0xFFD54A),
          .warning_weak = hex(0x000000),
          .danger = hex(0xFFA79E),
          .danger_text = hex(0xFFA79E),
          .danger_weak = hex(0x000000),
          .line = hex(0xFFFFFF),
          .control_edge = hex(0xFFFFFF),
          .view = hex(0x000000),
          .edge_px = 2,
          .note_edge_px = 2};
}

Theme Theme::of(ThemeChoice choice) {
  switch (choice) {
    case ThemeChoice::Dark:
      return dark();
    case ThemeChoice::HighContrast:
      return highContrast();
    case ThemeChoice::Light:
      break;
  }
  return light();
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
  result.setColor(QPalette::PlaceholderText, text_secondary);
  result.setColor(QPalette::Highlight, accent);
  result.setColor(QPalette::HighlightedText, on_accent);
  result.setColor(QPalette::ToolTipBase, text);
  result.setColor(QPalette::ToolTipText, surface);
  result.setColor(QPalette::Disabled, QPalette::WindowText, text_secondary);
  result.setColor(QPalette::Disabled, QPalette::Text, text_secondary);
  result.setColor(QPalette::Disabled, QPalette::ButtonText, text_secondary);
  return result;
}

double contrast(const QColor& a, const QColor& b) {
  const double one = luminance(a);
  const double other = luminance(b);
  return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

}  // namespace tarsus
