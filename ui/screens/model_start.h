#pragma once

#include <QWidget>

namespace tarsus {

/// What the window shows before there is a model: what to do, and how to make one.
class ModelStart : public QWidget {
  Q_OBJECT

 public:
  explicit ModelStart(QWidget* parent = nullptr);

 signals:
  void openRequested();
};

}  // namespace tarsus
