#include "ui/screens/sign_in_page.h"

#include "ui/parts/controls.h"
#include "ui/parts/field_frame.h"
#include "ui/parts/password_field.h"
#include "ui/parts/person_list.h"
#include "ui/parts/words.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace tarsus {

SignInPage::SignInPage(Session& session) : GatePage(452, tr("Sign in"), {}), session_(session) {
  column()->addWidget(makeLabel(tr("Who are you?"), TypeRole::Label));
  people_ = new PersonList;
  column()->addWidget(people_);
  column()->addSpacing(8);
  password_ = new PasswordField;
  password_->setObjectName(QStringLiteral("password"));
  frame_ = new FieldFrame(tr("Password"), password_);
  column()->addWidget(frame_);
  column()->addSpacing(8);
  go_ = makeButton(tr("Sign in"), QStringLiteral("primary"));
  go_->setObjectName(QStringLiteral("sign in"));
  column()->addWidget(go_);
  QPushButton* forgot = makeButton(tr("Forgot the password?"), QStringLiteral("quiet"));
  forgot->setObjectName(QStringLiteral("forgot"));
  column()->addWidget(forgot, 0, Qt::AlignRight);
  connect(go_, &QPushButton::clicked, this, &SignInPage::primary);
  connect(password_, &QLineEdit::returnPressed, this, &SignInPage::primary);
  connect(password_, &QLineEdit::textEdited, this, [this] {
    if (wait_s_ == 0) {
      frame_->clearError();
    }
  });
  connect(people_, &PersonList::chosen, this, [this] {
    password_->reset();
    frame_->clearError();
    password_->setFocus();
  });
  connect(forgot, &QPushButton::clicked, this, &SignInPage::forgotten);
  waiting_.setInterval(1000);
  connect(&waiting_, &QTimer::timeout, this, &SignInPage::tick);
}

void SignInPage::entered() {
  setText(QString::fromStdString(session_.station().clinic));
  people_->setPeople(session_.station().people);
  password_->reset();
  frame_->clearError();
  password_->setFocus();
}

QString SignInPage::person() const { return people_->currentName(); }

void SignInPage::primary() {
  if (busy_ || wait_s_ > 0) {
    return;
  }
  busy_ = true;
  setBusy(go_, true, tr("Signing in"));
  session_.signIn(person().toStdString(),
                  password_->text().toStdString(),
                  [this](const std::optional<SignInRefusal>& refusal) {
                    busy_ = false;
                    setBusy(go_, false, tr("Sign in"));
                    password_->reset();
                    if (refusal) {
                      show(*refusal);
                    }
                  });
}

void SignInPage::show(const SignInRefusal& refusal) {
  password_->setFocus();
  switch (refusal.error.code) {
    case ErrorCode::PasswordWrong:
      frame_->setError(refusal.tries_left > 0
                           ? tr("Wrong password. %n tries left.", nullptr, refusal.tries_left)
                           : tr("Wrong password. The next try has to wait."));
      break;
    case ErrorCode::SignInDelayed:
      wait_s_ = refusal.wait_s;
      go_->setEnabled(false);
      waiting_.start();
      tick();
      break;
    default:
      frame_->setError(sentenceOf(refusal.error));
  }
}

void SignInPage::tick() {
  if (wait_s_ <= 0) {
    waiting_.stop();
    go_->setEnabled(true);
    frame_->clearError();
    return;
  }
  frame_->setError(tr("Too many tries. Wait %n seconds.", nullptr, wait_s_));
  --wait_s_;
}

}  // namespace tarsus
