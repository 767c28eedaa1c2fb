#pragma once

#include <QWidget>

class QLabel;

namespace tarsus {

/// The bar at the foot: what is saved, what is shown, and what this program is not.
class StatusBar : public QWidget {
  Q_OBJECT

 public:
  explicit StatusBar(QWidget* parent = nullptr);
  void setSaved(const QString& text);
  void setMiddle(const QString& text);

 private:
  QLabel* saved_ = nullptr;
  QLabel* middle_ = nullptr;
};

}  // namespace tarsus
