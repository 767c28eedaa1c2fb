#include "ui/parts/empty_place.h"

#include "ui/parts/controls.h"
#include "ui/parts/foot_shape.h"
#include "ui/parts/icon_label.h"

#include <QHBoxLayout>
#include <QPainter>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {
namespace {

class DashedSole : public QWidget {
 public:
  DashedSole() { setFixedSize(72, 176); }

 protected:
  void paintEvent(QPaintEvent*) override {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QPen pen(Look::theme().control_edge, 2.0);
    pen.setDashPattern({3.5, 3.0});
    painter.setPen(pen);
    painter.drawPath(solePath(FootSide::Right, QRectF(rect()).adjusted(4, 4, -4, -4)));
  }
};

}  // namespace

EmptyPlace::EmptyPlace(const QString& icon, const QString& title, const QString& text, bool large) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(24, 24, 24, 24);
  layout->setSpacing(8);
  layout->addStretch(3);
  QWidget* picture = icon == QLatin1String("sole") ? static_cast<QWidget*>(new DashedSole)
                                                   : new IconLabel(icon, Tone::Secondary, 36);
  layout->addWidget(picture, 0, Qt::AlignHCenter);
  layout->addSpacing(8);
  title_ = makeLabel(title, large ? TypeRole::Title : TypeRole::Heading);
  text_ = makeLabel(text, TypeRole::Base, QStringLiteral("secondary"));
  for (QLabel* label : {title_, text_}) {
    label->setAlignment(Qt::AlignHCenter);
    layout->addWidget(label);
  }
  layout->addSpacing(8);
  buttons_ = new QHBoxLayout;
  buttons_->setSpacing(12);
  buttons_->addStretch();
  buttons_->addStretch();
  layout->addLayout(buttons_);
  layout->addStretch(4);
}

void EmptyPlace::setWords(const QString& title, const QString& text) {
  title_->setText(title);
  text_->setText(text);
}

QPushButton* EmptyPlace::addButton(const QString& text, const QString& role, const char* icon) {
  QPushButton* button = icon != nullptr ? makeButton(text, role, icon) : makeButton(text, role);
  button->setProperty("target", QStringLiteral("large"));
  buttons_->insertWidget(buttons_->count() - 1, button);
  return button;
}

}  // namespace tarsus
