#pragma once

#include "ui/look/theme.h"

#include <QFont>
#include <QObject>

class QWidget;

namespace tarsus {

/// Sizes of type [logical px at 100 %]: 12 small and chip, 13 label, 14 base, 15 list name,
/// 18 heading, 24 title, 32 scan figures, 36 key figure.
enum class TypeRole {
  Small,
  Chip,
  Label,
  Base,
  Strong,
  ListName,
  Heading,
  Title,
  ScanFigure,
  KeyFigure
};

/// How the whole program looks now: one theme, one scale of the text. Widgets that paint
/// themselves read it when they paint.
class Look : public QObject {
  Q_OBJECT

 public:
  static Look& instance();
  [[nodiscard]] static const Theme& theme() { return instance().theme_; }
  [[nodiscard]] static ThemeChoice choice() { return instance().choice_; }
  [[nodiscard]] static int percent() { return instance().percent_; }
  /// A length that grows with the text.
  [[nodiscard]] static int px(double at_100_percent);
  [[nodiscard]] static QFont font(TypeRole role);
  /// Gives a widget a role of type, which it keeps when the scale changes.
  static void setType(QWidget* widget, TypeRole role);
  /// Gives a widget a height that grows with the text.
  static void setFixedHeight(QWidget* widget, int at_100_percent);

  /// Dresses the whole program anew.
  /// @param percent  100 to 200
  void set(ThemeChoice choice, int percent);

 signals:
  void changed();

 private:
  Look() = default;
  Theme theme_ = Theme::light();
  ThemeChoice choice_ = ThemeChoice::Light;
  int percent_ = 100;
};

}  // namespace tarsus
