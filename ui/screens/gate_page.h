#pragma once

#include <QWidget>

class QLabel;
class QVBoxLayout;
class QPushButton;

namespace tarsus {

/// One page of the gate: a column of fixed width in the middle that scrolls where it must.
class GatePage : public QWidget {
  Q_OBJECT

 public:
  GatePage(int width, const QString& title, const QString& text, QWidget* parent = nullptr);
  virtual void entered() {}
  virtual void primary() {}

 protected:
  [[nodiscard]] QVBoxLayout* column() { return column_; }
  void setText(const QString& text);
  /// While an answer is awaited: the words on the button, and no second press.
  static void setBusy(QPushButton* button, bool busy, const QString& text);

 private:
  QVBoxLayout* column_ = nullptr;
  QLabel* text_ = nullptr;
};

}  // namespace tarsus
