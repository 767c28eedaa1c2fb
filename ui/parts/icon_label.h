#pragma once

#include "ui/look/icons.h"

#include <QWidget>

namespace tarsus {

/// An icon that is only looked at.
class IconLabel : public QWidget {
  Q_OBJECT

 public:
  IconLabel(QString name, Tone tone, int size_at_100_percent = 20, QWidget* parent = nullptr);
  [[nodiscard]] QSize sizeHint() const override;
  [[nodiscard]] QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString name_;
  Tone tone_;
  int size_;
};

}  // namespace tarsus
