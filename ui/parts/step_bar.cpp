#include "ui/parts/step_bar.h"

#include "ui/look/icons.h"
#include "ui/parts/controls.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QPainter>
#include <QVariant>

namespace tarsus {
namespace {

/// A disc with the number, or a tick once the step was passed, and the name.
class StepButton : public QToolButton {
 public:
  StepButton(int number, const QString& name) : number_(number), name_(name) {
    setCheckable(true);
    setCursor(Qt::PointingHandCursor);
    setFocusPolicy(Qt::TabFocus);
    setProperty("ring", true);
    setText(name);
  }
  void setPassed(bool passed) {
    passed_ = passed;
    update();
  }
  [[nodiscard]] QSize sizeHint() const override {
    const QFontMetrics metrics(Look::font(TypeRole::Label));
    return {metrics.horizontalAdvance(name_) + Look::px(62), Look::px(40)};
  }
  [[nodiscard]] QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent*) override {
    const Theme& theme = Look::theme();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    if (isChecked()) {
      painter.setPen(theme.note_edge_px > 0 ? QPen(theme.accent, 2.0) : QPen(Qt::NoPen));
      painter.setBrush(theme.accent_weak);
      painter.drawRoundedRect(QRectF(rect()).adjusted(1, 1, -1, -1), 6.0, 6.0);
    }
    const QColor ink = isChecked() ? theme.accent_text
                       : passed_   ? theme.text
                                   : theme.text_secondary;
    const double side = Look::px(22);
    const QRectF disc(Look::px(14), (height() - side) / 2.0, side, side);
    const bool ticked = passed_ && !isChecked();
    painter.setPen(ticked ? QPen(Qt::NoPen) : QPen(ink, 1.5));
    painter.setBrush(ticked ? QBrush(theme.accent) : QBrush(Qt::NoBrush));
    painter.drawEllipse(disc);
    painter.setFont(Look::font(TypeRole::Label));
    if (ticked) {
      drawIcon(painter, QStringLiteral("check"), disc.adjusted(4, 4, -4, -4), theme.on_accent);
    } else {
      painter.setPen(ink);
      painter.setFont(Look::font(TypeRole::Chip));
      painter.drawText(disc, Qt::AlignCenter, QString::number(number_));
    }
    painter.setFont(Look::font(TypeRole::Label));
    painter.setPen(ink);
    painter.drawText(
        QRectF(rect()).adjusted(Look::px(46), 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, name_);
  }

 private:
  int number_;
  QString name_;
  bool passed_ = false;
};

}  // namespace

StepBar::StepBar(QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(4);
  auto* group = new QButtonGroup(this);
  const QString names[] = {tr("Scan"), tr("Form"), tr("Outline"), tr("Review"), tr("Report")};
  for (int i = 0; i < 5; ++i) {
    auto* button = new StepButton(i + 1, names[i]);
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
    static_cast<StepButton*>(button)->setPassed(i < current);
  }
  const QString name = buttons_[static_cast<std::size_t>(current)]->text();
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
