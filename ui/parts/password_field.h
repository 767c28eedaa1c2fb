#pragma once

#include <QLineEdit>

namespace tarsus {

/// A field whose letters are hidden until the eye at its end is pressed.
class PasswordField : public QLineEdit {
  Q_OBJECT

 public:
  explicit PasswordField(QWidget* parent = nullptr);
  /// Empties it and hides its letters.
  void reset();

 private:
  void setShown(bool shown);
  QAction* eye_ = nullptr;
};

}  // namespace tarsus
