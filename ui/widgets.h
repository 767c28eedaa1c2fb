#pragma once

#include "ui/theme.h"

#include <QFrame>
#include <QLabel>
#include <QPushButton>

namespace tarsus {

/// A word-wrapped label in a role of the theme; `tone` is "secondary" or empty.
[[nodiscard]] QLabel* makeLabel(const QString& text,
                                TypeRole role,
                                const QString& tone = {},
                                QWidget* parent = nullptr);

/// @param role  "primary" or empty
[[nodiscard]] QPushButton* makeButton(const QString& text,
                                      const QString& role = {},
                                      QWidget* parent = nullptr);

/// A frame that the style sheet paints: "card", "well" or "line".
[[nodiscard]] QFrame* makeFrame(const QString& role, QWidget* parent = nullptr);

/// The product's mark: a foot in a teal square.
class Mark : public QWidget {
  Q_OBJECT

 public:
  explicit Mark(const Theme& theme, QWidget* parent = nullptr);
  [[nodiscard]] QSize sizeHint() const override { return {28, 28}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QColor square_;
  QColor foot_;
};

}  // namespace tarsus
