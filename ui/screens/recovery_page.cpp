#include "ui/screens/recovery_page.h"

#include "ui/parts/controls.h"
#include "ui/parts/field_frame.h"

#include <QFileDialog>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPrintDialog>
#include <QPrinter>
#include <QSaveFile>
#include <QTextDocument>
#include <QVBoxLayout>

namespace tarsus {
namespace {

constexpr int kAskedGroup = 3;  ///< in the middle: not read off the beginning or the end

}  // namespace

RecoveryPage::RecoveryPage()
    : GatePage(
          532,
          tr("Keep the recovery code"),
          tr("It opens the records when a password is forgotten. It is shown only now. Without "
             "it and without a password nobody can read them.")) {
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* inside = new QVBoxLayout(card);
  inside->setContentsMargins(24, 20, 24, 20);
  code_ = makeLabel({}, TypeRole::Heading);
  code_->setObjectName(QStringLiteral("recovery code"));
  code_->setAlignment(Qt::AlignCenter);
  code_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  inside->addWidget(code_);
  column()->addWidget(card);
  auto* row = new QHBoxLayout;
  row->setSpacing(12);
  QPushButton* print = makeButton(tr("Print"), {}, "print");
  QPushButton* save = makeButton(tr("Save as a file"), {}, "save");
  done_ = makeLabel({}, TypeRole::Small, QStringLiteral("secondary"));
  row->addWidget(print);
  row->addWidget(save);
  row->addWidget(done_, 1);
  column()->addLayout(row);
  column()->addWidget(makeLabel(tr("Keep it apart from this computer, as you keep a key."),
                                TypeRole::Small,
                                QStringLiteral("secondary")));
  column()->addSpacing(8);
  typed_ = new QLineEdit;
  typed_->setObjectName(QStringLiteral("code group"));
  frame_ = new FieldFrame(tr("To be sure: type group %1 of the code").arg(kAskedGroup + 1), typed_);
  column()->addWidget(frame_);
  column()->addSpacing(8);
  QPushButton* go = makeButton(tr("I have kept the code"), QStringLiteral("primary"));
  go->setObjectName(QStringLiteral("kept"));
  column()->addWidget(go);
  asked_ = kAskedGroup;
  connect(print, &QPushButton::clicked, this, &RecoveryPage::print);
  connect(save, &QPushButton::clicked, this, &RecoveryPage::save);
  connect(go, &QPushButton::clicked, this, &RecoveryPage::primary);
  connect(typed_, &QLineEdit::returnPressed, this, &RecoveryPage::primary);
  connect(typed_, &QLineEdit::textEdited, this, [this] { frame_->clearError(); });
}

void RecoveryPage::setCode(const QString& code) {
  groups_ = code.split(QLatin1Char('-'), Qt::SkipEmptyParts);
  if (groups_.size() == 1) {
    groups_ = code.split(QLatin1Char(' '), Qt::SkipEmptyParts);
  }
  asked_ = qBound(0, kAskedGroup, groups_.size() - 1);
  // Four and three, so that a group is found by counting.
  const QString gap = QStringLiteral("   ");
  code_->setText(groups_.mid(0, 4).join(gap) + QLatin1Char('\n') + groups_.mid(4).join(gap));
}

void RecoveryPage::entered() { typed_->setFocus(); }

void RecoveryPage::primary() {
  if (groups_.isEmpty()) {
    return;
  }
  if (typed_->text().trimmed().compare(groups_.at(asked_), Qt::CaseInsensitive) != 0) {
    frame_->setError(tr("This is not group %1.").arg(asked_ + 1));
    typed_->setFocus();
    return;
  }
  groups_.clear();
  code_->clear();
  typed_->clear();
  emit kept();
}

QString RecoveryPage::sheet() const {
  return tr("Tarsus: recovery code") + QStringLiteral("\n\n") + groups_.join(QLatin1Char('-')) +
         QStringLiteral("\n\n") +
         tr("It opens the records when a password is forgotten. Keep it apart from the computer.") +
         QLatin1Char('\n');
}

void RecoveryPage::print() {
  QPrinter printer;
  QPrintDialog dialog(&printer, this);
  if (dialog.exec() == QDialog::Accepted) {
    QTextDocument document;
    document.setDefaultFont(Look::font(TypeRole::Heading));
    document.setPlainText(sheet());
    document.print(&printer);
    done_->setText(tr("Sent to the printer."));
  }
}

void RecoveryPage::save() {
  const QString path = QFileDialog::getSaveFileName(
      this, tr("Save the recovery code"), tr("Tarsus recovery code.txt"));
  if (path.isEmpty()) {
    return;
  }
  QSaveFile file(path);
  const QByteArray text = sheet().toUtf8();
  const bool written =
      file.open(QIODevice::WriteOnly) && file.write(text) == text.size() && file.commit();
  done_->setText(written ? tr("Saved.") : tr("Not saved. Choose another folder."));
}

}  // namespace tarsus
