#pragma once

#include "ui/screens/model_facts.h"

#include <QWidget>

class QVBoxLayout;

namespace tarsus {

/// The model's facts at the right of the picture.
class ModelPanel : public QWidget {
  Q_OBJECT

 public:
  explicit ModelPanel(QWidget* parent = nullptr);

  void showFacts(const QString& file_name, const ModelFacts& facts, const std::string& sha256);

 private:
  void clear();

  QVBoxLayout* cards_ = nullptr;
};

}  // namespace tarsus
