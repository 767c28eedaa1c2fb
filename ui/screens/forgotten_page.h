#pragma once

#include "ui/screens/gate_page.h"
#include "ui/work/session.h"

class QLineEdit;

namespace tarsus {

class FieldFrame;
class PasswordField;

/// A forgotten password: the recovery code and a new one.
class ForgottenPage : public GatePage {
  Q_OBJECT

 public:
  explicit ForgottenPage(Session& session);
  void setPerson(const QString& name);
  void entered() override;
  void primary() override;

 signals:
  void givenUp();

 private:
  [[nodiscard]] bool check();

  Session& session_;
  QString name_;
  QLineEdit* code_ = nullptr;
  PasswordField* password_ = nullptr;
  PasswordField* again_ = nullptr;
  FieldFrame* code_frame_ = nullptr;
  FieldFrame* password_frame_ = nullptr;
  FieldFrame* again_frame_ = nullptr;
  QPushButton* go_ = nullptr;
  bool busy_ = false;
};

}  // namespace tarsus
