#pragma once

#include <QPointer>
#include <QWidget>

namespace tarsus {

/// A ring around the control that has the focus, 2 px with a gap of 2 px; the style sheet cannot
/// draw outside of a control. Shown on fields always, on buttons when keys brought the focus.
class FocusRing : public QWidget {
  Q_OBJECT

 public:
  explicit FocusRing(QWidget* window);

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void follow(QWidget* target);
  void place();

  QPointer<QWidget> target_;
  bool by_keys_ = false;
};

}  // namespace tarsus
