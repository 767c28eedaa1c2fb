#include "ui/parts/choice_row.h"

#include "ui/look/icons.h"
#include "ui/parts/controls.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QVariant>

namespace tarsus {

ChoiceRow::ChoiceRow(const QStringList& texts, QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  group_ = new QButtonGroup(this);
  for (int i = 0; i < texts.size(); ++i) {
    auto* button = new QToolButton;
    button->setText(texts.at(i));
    button->setCheckable(true);
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setFocusPolicy(Qt::StrongFocus);
    button->setCursor(Qt::PointingHandCursor);
    button->setProperty("target", QStringLiteral("large"));
    button->setProperty("segment",
                        i == 0                  ? QStringLiteral("first")
                        : i + 1 == texts.size() ? QStringLiteral("last")
                                                : QStringLiteral("middle"));
    Look::setType(button, TypeRole::Label);
    group_->addButton(button, i);
    row->addWidget(button);
  }
  row->addStretch();
  connect(group_, &QButtonGroup::idToggled, this, [this](int, bool) { showTicks(); });
  connect(group_, &QButtonGroup::idClicked, this, &ChoiceRow::chosen);
}

void ChoiceRow::setCurrent(int index) {
  if (QAbstractButton* button = group_->button(index); button != nullptr) {
    button->setChecked(true);
  } else if (QAbstractButton* checked = group_->checkedButton(); checked != nullptr) {
    group_->setExclusive(false);
    checked->setChecked(false);
    group_->setExclusive(true);
  }
}

int ChoiceRow::current() const { return group_->checkedId(); }

void ChoiceRow::setTexts(const QStringList& texts) {
  for (int i = 0; i < texts.size(); ++i) {
    group_->button(i)->setText(texts.at(i));
  }
}

void ChoiceRow::setTicks(bool ticks) {
  ticks_ = ticks;
  showTicks();
}

void ChoiceRow::showTicks() {
  for (QAbstractButton* button : group_->buttons()) {
    const bool ticked = ticks_ && button->isChecked();
    button->setIcon(ticked ? themeIcon(QStringLiteral("check"), Tone::Accent) : QIcon());
  }
}

}  // namespace tarsus
