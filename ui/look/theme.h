#pragma once

#include <QColor>
#include <QPalette>
#include <QString>

#include <array>

namespace tarsus {

enum class ThemeChoice { Light, Dark, HighContrast };
inline constexpr std::array kThemeChoices{
    ThemeChoice::Light, ThemeChoice::Dark, ThemeChoice::HighContrast};

/// Every colour of the window, by role; style sheet, palette, charts and VTK take theirs from here.
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
  QColor warning;  ///< for lines; too pale for text on white
  QColor warning_text;
  QColor warning_weak;
  QColor danger;
  QColor danger_text;
  QColor danger_weak;
  QColor line;
  QColor control_edge;
  QColor view;
  int edge_px = 1;       ///< of controls
  int note_edge_px = 0;  ///< of notes and chips, which high contrast tells apart by edges only

  [[nodiscard]] static Theme light();
  [[nodiscard]] static Theme dark();
  [[nodiscard]] static Theme highContrast();
  [[nodiscard]] static Theme of(ThemeChoice choice);

  [[nodiscard]] QPalette palette() const;
};

/// Colours, edges and sizes of all controls; never fonts, which a style sheet would keep from
/// scaling.
/// @param percent    of the text, 100 to 200: heights and paddings grow with it
/// @param icon_file  where a small picture in a colour lies, for what only a style sheet can place
[[nodiscard]] QString styleSheet(const Theme& theme,
                                 int percent,
                                 QString (*icon_file)(const QString& name, const QColor& color));

/// WCAG 2 contrast of two opaque colours, 1 to 21.
[[nodiscard]] double contrast(const QColor& a, const QColor& b);

}  // namespace tarsus
