#include "ui/screens/forgotten_page.h"

#include "ui/parts/controls.h"
#include "ui/parts/field_frame.h"
#include "ui/parts/password_field.h"
#include "ui/parts/words.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace tarsus {

ForgottenPage::ForgottenPage(Session& session)
    : GatePage(452, tr("A new password"), {}), session_(session) {
  code_ = new QLineEdit;
  code_->setObjectName(QStringLiteral("typed recovery code"));
  code_frame_ = new FieldFrame(
      tr("Recovery code"), code_, tr("Seven groups of five, as printed at the first start"));
  password_ = new PasswordField;
  password_frame_ = new FieldFrame(tr("New password"), password_, tr("At least 10 characters"));
  again_ = new PasswordField;
  again_frame_ = new FieldFrame(tr("New password again"), again_);
  for (FieldFrame* frame : {code_frame_, password_frame_, again_frame_}) {
    column()->addWidget(frame);
    connect(qobject_cast<QLineEdit*>(frame->field()),
            &QLineEdit::textEdited,
            frame,
            &FieldFrame::clearError);
  }
  column()->addSpacing(8);
  go_ = makeButton(tr("Change the password and sign in"), QStringLiteral("primary"));
  column()->addWidget(go_);
  QPushButton* back = makeButton(tr("Back"), QStringLiteral("quiet"), "chevron-left");
  column()->addWidget(back, 0, Qt::AlignLeft);
  connect(go_, &QPushButton::clicked, this, &ForgottenPage::primary);
  connect(again_, &QLineEdit::returnPressed, this, &ForgottenPage::primary);
  connect(back, &QPushButton::clicked, this, &ForgottenPage::givenUp);
}

void ForgottenPage::setPerson(const QString& name) {
  name_ = name;
  setText(tr("For %1.").arg(name));
}

void ForgottenPage::entered() {
  code_->clear();
  password_->reset();
  again_->reset();
  code_->setFocus();
}

bool ForgottenPage::check() {
  constexpr int kShortest = 10;
  const bool long_enough = password_->text().size() >= kShortest;
  const bool same = password_->text() == again_->text();
  password_frame_->setError(long_enough ? QString() : tr("At least 10 characters, please."));
  again_frame_->setError(same ? QString() : tr("The two passwords differ."));
  code_frame_->setError(code_->text().trimmed().isEmpty() ? tr("Type the recovery code.")
                                                          : QString());
  return long_enough && same && !code_->text().trimmed().isEmpty();
}

void ForgottenPage::primary() {
  if (busy_ || !check()) {
    return;
  }
  busy_ = true;
  setBusy(go_, true, tr("Opening the records"));
  session_.resetPassword(
      name_.toStdString(),
      code_->text().toStdString(),
      password_->text().toStdString(),
      [this](const std::optional<SignInRefusal>& refusal) {
        busy_ = false;
        setBusy(go_, false, tr("Change the password and sign in"));
        if (!refusal) {
          return;
        }
        code_frame_->setError(refusal->error.code == ErrorCode::PasswordWrong
                                  ? tr("This is not the code. Check each group against the paper.")
                              : refusal->wait_s > 0
                                  ? tr("Too many tries. Wait %n seconds.", nullptr, refusal->wait_s)
                                  : sentenceOf(refusal->error));
        code_->setFocus();
      });
}

}  // namespace tarsus
