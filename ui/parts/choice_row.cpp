#include "ui/parts/choice_row.h"

#include "ui/look/icons.h"
#include "ui/parts/controls.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QStyleOptionToolButton>
#include <QStylePainter>
#include <QVariant>

#include <utility>

namespace tarsus {
namespace {

/// Tick and text in the middle together, which a style sheet's button cannot do where it is wide.
class Segment : public QToolButton {
 protected:
  void paintEvent(QPaintEvent*) override {
    QStylePainter painter(this);
    QStyleOptionToolButton option;
    initStyleOption(&option);
    const QString words = std::exchange(option.text, {});
    const bool ticked = !std::exchange(option.icon, {}).isNull();
    painter.drawComplexControl(QStyle::CC_ToolButton, option);
    const Theme& theme = Look::theme();
    const QColor ink = !isEnabled()  ? theme.text_secondary
                       : isChecked() ? theme.accent_text
                                     : theme.text;
    const int side = ticked ? Look::px(16) : 0;
    const int gap = ticked ? Look::px(8) : 0;
    const int room = width() - side - gap - Look::px(8);
    const QString shown = fontMetrics().elidedText(words, Qt::ElideRight, room);
    const int left = (width() - side - gap - fontMetrics().horizontalAdvance(shown)) / 2;
    painter.setRenderHint(QPainter::Antialiasing);
    if (ticked) {
      drawIcon(
          painter, QStringLiteral("check"), QRectF(left, (height() - side) / 2.0, side, side), ink);
    }
    painter.setPen(ink);
    painter.drawText(QRect(left + side + gap, 0, width() - left - side - gap, height()),
                     Qt::AlignLeft | Qt::AlignVCenter,
                     shown);
  }
};

}  // namespace

ChoiceRow::ChoiceRow(const QStringList& texts, QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  group_ = new QButtonGroup(this);
  for (int i = 0; i < texts.size(); ++i) {
    auto* button = new Segment;
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
  connect(group_, &QButtonGroup::idPressed, this, [this](int) { before_ = current(); });
  connect(group_, &QButtonGroup::idClicked, this, [this](int index) {
    if (may_be_none_ && index == before_) {
      takeBack();
    } else {
      emit chosen(index);
    }
    before_ = -1;
  });
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

void ChoiceRow::setFills(const QString& of_what) {
  may_be_none_ = true;
  auto* row = static_cast<QHBoxLayout*>(layout());
  delete row->takeAt(row->count() - 1);
  const int count = static_cast<int>(group_->buttons().size());
  for (int i = 0; i < count; ++i) {
    QAbstractButton* button = group_->button(i);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    button->setAccessibleName(tr("%1, %2, %3 of %4", "field, choice, its number, how many")
                                  .arg(of_what, button->text())
                                  .arg(i + 1)
                                  .arg(count));
    row->setStretch(i, 1);
  }
}

void ChoiceRow::focusCurrent() {
  QAbstractButton* button = group_->button(qMax(0, current()));
  if (button != nullptr) {
    button->setFocus(Qt::TabFocusReason);
  }
}

void ChoiceRow::takeBack() {
  setCurrent(-1);
  emit chosen(-1);
}

void ChoiceRow::keyPressEvent(QKeyEvent* event) {
  const int index = event->key() - Qt::Key_1;
  const bool plain = (event->modifiers() & ~Qt::KeypadModifier) == Qt::NoModifier;
  if (plain && index >= 0 && index < group_->buttons().size()) {
    setCurrent(index);
    group_->button(index)->setFocus(Qt::OtherFocusReason);
    emit chosen(index);
    return;
  }
  const bool takes_back = event->key() == Qt::Key_Delete || event->key() == Qt::Key_Backspace;
  if (may_be_none_ && takes_back && current() >= 0) {
    takeBack();
    return;
  }
  QWidget::keyPressEvent(event);
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
