#pragma once

#include "ui/screens/gate_page.h"
#include "ui/work/session.h"

#include <QTimer>

namespace tarsus {

class FieldFrame;
class PasswordField;
class PersonList;

/// Who are you, and the password.
class SignInPage : public GatePage {
  Q_OBJECT

 public:
  explicit SignInPage(Session& session);
  void entered() override;
  void primary() override;
  [[nodiscard]] QString person() const;

 signals:
  void forgotten();

 private:
  void show(const SignInRefusal& refusal);
  void tick();

  Session& session_;
  PersonList* people_ = nullptr;
  PasswordField* password_ = nullptr;
  FieldFrame* frame_ = nullptr;
  QPushButton* go_ = nullptr;
  QTimer waiting_;
  int wait_s_ = 0;
  bool busy_ = false;
};

}  // namespace tarsus
