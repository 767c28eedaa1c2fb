#pragma once

#include <QWidget>

namespace tarsus {

/// What the window shows before there is a model: what to do, and how to make one.
class StartPage : public QWidget {
  Q_OBJECT

 public:
  explicit StartPage(QWidget* parent = nullptr);

 signals:
  void openRequested();
};

}  // namespace tarsus
