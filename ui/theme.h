#pragma once

#include <QColor>
#include <QFont>
#include <QPalette>
#include <QString>

namespace tarsus {

/// Every colour of the window, by role; style sheet, palette and VTK take theirs from here.
struct Theme {
  QColor background;
  QColor surface;
  QColor sunk;
  QColor text;
  QColor text_secondary;
  QColor accent;
  QColor on_accent;
  QColor accent_text;
  QColor accent_weak;
  QColor danger;
  QColor danger_text;
  QColor danger_weak;
  QColor warning_text;
  QColor warning_weak;
  QColor line;
  QColor control_edge;
  QColor view;

  [[nodiscard]] static Theme light();

  [[nodiscard]] QPalette palette() const;
  /// Colours, edges and sizes; never fonts, which a style sheet would keep from scaling.
  [[nodiscard]] QString styleSheet() const;
};

/// Sizes of type [logical px at 100 %]: 12 small, 14 base, 18 heading, 24 title.
enum class TypeRole { Small, Label, Base, Heading, Title };
[[nodiscard]] QFont themeFont(TypeRole role);

/// WCAG 2 contrast of two opaque colours, 1 to 21.
[[nodiscard]] double contrast(const QColor& a, const QColor& b);

}  // namespace tarsus
