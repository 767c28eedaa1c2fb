#pragma once

#include "ui/screens/gate_page.h"

class QLabel;
class QLineEdit;

namespace tarsus {

class FieldFrame;

/// The recovery code, shown this once: printed or saved, and shown to be kept by typing a group.
class RecoveryPage : public GatePage {
  Q_OBJECT

 public:
  RecoveryPage();
  void setCode(const QString& code);
  void entered() override;
  void primary() override;
  /// The group that is asked for, from 1.
  [[nodiscard]] int askedGroup() const { return asked_ + 1; }

 signals:
  void kept();

 private:
  void print();
  void save();
  [[nodiscard]] QString sheet() const;

  QStringList groups_;
  int asked_ = 0;
  QLabel* code_ = nullptr;
  QLineEdit* typed_ = nullptr;
  FieldFrame* frame_ = nullptr;
  QLabel* done_ = nullptr;
};

}  // namespace tarsus
