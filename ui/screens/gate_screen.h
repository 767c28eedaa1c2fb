#pragma once

#include "ui/screens/screen.h"

class QStackedWidget;
class QVBoxLayout;

namespace tarsus {

class ForgottenPage;
class RecoveryPage;
class FirstRunPage;
class Session;
class SignInPage;
class Note;

/// Before anybody works: signing in, the first start, the recovery code, a forgotten password.
class GateScreen : public Screen {
  Q_OBJECT

 public:
  explicit GateScreen(Session& session, QWidget* parent = nullptr);
  void entered() override;
  void primary() override;

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void follow();
  void show(QWidget* page);
  [[nodiscard]] QWidget* makeFailed();

  Session& session_;
  QWidget* brand_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  SignInPage* sign_in_ = nullptr;
  FirstRunPage* first_run_ = nullptr;
  RecoveryPage* recovery_ = nullptr;
  ForgottenPage* forgotten_ = nullptr;
  QWidget* opening_ = nullptr;
  QWidget* failed_ = nullptr;
  Note* failure_ = nullptr;
};

}  // namespace tarsus
