#pragma once

#include <QWidget>

class QHBoxLayout;
class QLabel;
class QPushButton;

namespace tarsus {

/// What stands where there is nothing yet: a picture, what is missing, what to do, and the act.
class EmptyPlace : public QWidget {
  Q_OBJECT

 public:
  /// @param icon  of resources/icons; "sole" draws a dashed foot
  EmptyPlace(const QString& icon, const QString& title, const QString& text, bool large = false);
  void setWords(const QString& title, const QString& text);
  /// A button under the text, in order.
  QPushButton* addButton(const QString& text, const QString& role = {}, const char* icon = nullptr);

 private:
  QLabel* title_ = nullptr;
  QLabel* text_ = nullptr;
  QHBoxLayout* buttons_ = nullptr;
};

}  // namespace tarsus
