#include "ui/parts/scan_dialog.h"

#include "ui/parts/controls.h"
#include "ui/parts/icon_label.h"
#include "ui/parts/stage_mark.h"

#include <QAccessible>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {

ScanDialog::ScanDialog(QWidget* over) : QFrame(over), over_(over) {
  setProperty("role", QStringLiteral("dialog"));
  setAccessibleName(tr("Message"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  over->installEventFilter(this);
  hide();
}

void ScanDialog::open(Words words) {
  if (!isHidden() && words_.id == words.id) {
    return;
  }
  words_ = std::move(words);
  build();
  show();
  raise();
  place();
  auto* first = inside_->findChild<QPushButton*>(
      words_.second_is_safe ? QLatin1String(words_.second.name) : QLatin1String(words_.first.name));
  if (first != nullptr) {
    first->setFocus(Qt::OtherFocusReason);
  }
  setAccessibleDescription(words_.title + QLatin1Char(' ') + words_.text);
  QAccessibleEvent alert(this, QAccessible::Alert);
  QAccessible::updateAccessibility(&alert);
}

void ScanDialog::close(const QString& id) {
  if (!isHidden() && (id.isEmpty() || id == words_.id)) {
    hide();
    over_->setFocus();
  }
}

void ScanDialog::build() {
  if (inside_ != nullptr) {
    inside_->hide();
    inside_->deleteLater();
  }
  inside_ = new QWidget;
  layout()->addWidget(inside_);
  auto* row = new QHBoxLayout(inside_);
  row->setContentsMargins(32, 28, 40, 32);
  row->setSpacing(16);
  row->addWidget(new IconLabel(words_.icon, Tone::Danger, 32), 0, Qt::AlignTop);
  auto* column = new QVBoxLayout;
  column->setSpacing(8);
  row->addLayout(column, 1);
  column->addWidget(makeLabel(words_.title, TypeRole::Title));
  column->addWidget(makeLabel(words_.text, TypeRole::Base));
  auto* steps = new QGridLayout;
  steps->setVerticalSpacing(8);
  steps->setHorizontalSpacing(12);
  steps->setColumnStretch(1, 1);
  int line = 0;
  for (const QString& step : words_.steps) {
    steps->addWidget(
        makeLine(QString::number(line + 1), TypeRole::Label, QStringLiteral("secondary")),
        line,
        0,
        Qt::AlignHCenter);
    steps->addWidget(makeLabel(step, TypeRole::Base), line, 1);
    ++line;
  }
  if (!words_.waiting.isEmpty()) {
    auto* mark = new StageMark;
    mark->setKind(StageMark::Kind::Running);
    steps->addWidget(mark, line, 0);
    steps->addWidget(
        makeLabel(words_.waiting, TypeRole::Strong, QStringLiteral("accent")), line, 1);
  }
  column->addSpacing(4);
  column->addLayout(steps);
  column->addSpacing(12);
  auto* buttons = new QHBoxLayout;
  buttons->setSpacing(12);
  for (Act* each : {&words_.first, &words_.second}) {
    if (each->text.isEmpty()) {
      continue;
    }
    const bool filled = each == &words_.first;
    QPushButton* button = makeButton(each->text, filled ? QStringLiteral("primary") : QString());
    button->setObjectName(QLatin1String(each->name));
    button->setProperty("target", QStringLiteral("large"));
    connect(button, &QPushButton::clicked, this, [this, act = each->act] {
      close();
      act();
    });
    buttons->addWidget(button);
  }
  buttons->addStretch();
  column->addLayout(buttons);
  if (!words_.technician.isEmpty()) {
    QPushButton* ask = makeButton(tr("Details for the technician"), QStringLiteral("quiet"));
    QLabel* details = makeLabel(words_.technician, TypeRole::Small, QStringLiteral("secondary"));
    details->hide();
    connect(ask, &QPushButton::clicked, this, [this, details] {
      details->setVisible(details->isHidden());
      place();
    });
    column->addWidget(ask, 0, Qt::AlignLeft);
    column->addWidget(details);
  }
}

void ScanDialog::place() {
  const int wide = qMin(over_->width() - 32, Look::px(520));
  setFixedWidth(qMax(200, wide));
  layout()->activate();
  const int tall = layout()->totalHeightForWidth(width());
  setFixedHeight(tall);
  move((over_->width() - width()) / 2, qMax(0, (over_->height() - tall) / 2));
}

bool ScanDialog::eventFilter(QObject* watched, QEvent* event) {
  if (watched == over_ && event->type() == QEvent::Resize && !isHidden()) {
    place();
  }
  return QFrame::eventFilter(watched, event);
}

void ScanDialog::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape) {
    const Act safe = words_.second_is_safe ? words_.second : words_.first;
    close();
    safe.act();
    return;
  }
  QFrame::keyPressEvent(event);
}

}  // namespace tarsus
