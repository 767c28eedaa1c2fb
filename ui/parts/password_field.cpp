#include "ui/parts/password_field.h"

#include "ui/look/icons.h"

#include <QAction>

namespace tarsus {

PasswordField::PasswordField(QWidget* parent) : QLineEdit(parent) {
  setContextMenuPolicy(Qt::NoContextMenu);
  setInputMethodHints(Qt::ImhSensitiveData | Qt::ImhNoPredictiveText | Qt::ImhNoAutoUppercase);
  eye_ = addAction(themeIcon(QStringLiteral("eye")), QLineEdit::TrailingPosition);
  eye_->setCheckable(true);
  connect(eye_, &QAction::toggled, this, &PasswordField::setShown);
  setShown(false);
}

void PasswordField::reset() {
  clear();
  eye_->setChecked(false);
}

void PasswordField::setShown(bool shown) {
  setEchoMode(shown ? QLineEdit::Normal : QLineEdit::Password);
  eye_->setText(shown ? tr("Hide password") : tr("Show password"));
  eye_->setToolTip(eye_->text());
  eye_->setIcon(themeIcon(shown ? QStringLiteral("eye-off") : QStringLiteral("eye")));
}

}  // namespace tarsus
