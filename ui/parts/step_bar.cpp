#include "ui/parts/step_bar.h"

#include "ui/look/icons.h"
#include "ui/parts/controls.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QVariant>

namespace tarsus {

StepBar::StepBar(QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(4);
  auto* group = new QButtonGroup(this);
  const QString names[] = {tr("Scan"), tr("Form"), tr("Outline"), tr("Review"), tr("Report")};
  for (int i = 0; i < 5; ++i) {
    auto* button = new QToolButton;
    button->setText(tr("%1  %2", "number and name of a step").arg(i + 1).arg(names[i]));
    button->setCheckable(true);
    button->setToolTip(tr("%1 (Alt+%2)").arg(names[i]).arg(i + 1));
    button->setAccessibleName(tr("Step %1 of 5, %2").arg(i + 1).arg(names[i]));
    Look::setType(button, TypeRole::Label);
    group->addButton(button, i);
    row->addWidget(button);
    buttons_.push_back(button);
    connect(button, &QToolButton::clicked, this, [this, i] { emit stepChosen(i); });
  }
  short_ = makeLine({}, TypeRole::Label);
  row->addWidget(short_);
  setStep(0, 0);
}

void StepBar::setStep(int current, int reached) {
  current_ = current;
  for (int i = 0; i < 5; ++i) {
    QToolButton* button = buttons_[static_cast<std::size_t>(i)];
    button->setEnabled(i <= reached);
    button->setChecked(i == current);
  }
  const QString name =
      buttons_[static_cast<std::size_t>(current)]->text().section(QStringLiteral("  "), 1);
  short_->setText(tr("%1 of 5: %2").arg(current + 1).arg(name));
  setShort(is_short_);
}

void StepBar::setShort(bool is_short) {
  is_short_ = is_short;
  for (QToolButton* button : buttons_) {
    button->setVisible(!is_short);
  }
  short_->setVisible(is_short);
}

}  // namespace tarsus
