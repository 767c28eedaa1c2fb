#include "ui/widgets.h"

#include <QPainter>
#include <QPainterPath>
#include <QVariant>

namespace tarsus {

QLabel* makeLabel(const QString& text, TypeRole role, const QString& tone, QWidget* parent) {
  auto* label = new QLabel(text, parent);
  label->setFont(themeFont(role));
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  if (!tone.isEmpty()) {
    label->setProperty("tone", tone);
  }
  return label;
}

QPushButton* makeButton(const QString& text, const QString& role, QWidget* parent) {
  auto* button = new QPushButton(text, parent);
  button->setFont(themeFont(TypeRole::Label));
  button->setCursor(Qt::PointingHandCursor);
  if (!role.isEmpty()) {
    button->setProperty("role", role);
  }
  return button;
}

QFrame* makeFrame(const QString& role, QWidget* parent) {
  auto* frame = new QFrame(parent);
  frame->setProperty("role", role);
  if (role == QLatin1String("line")) {
    frame->setFixedHeight(1);
  }
  return frame;
}

Mark::Mark(const Theme& theme, QWidget* parent)
    : QWidget(parent), square_(theme.accent), foot_(theme.on_accent) {
  setFixedSize(sizeHint());
}

void Mark::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(square_);
  painter.drawRoundedRect(rect(), 6.0, 6.0);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(foot_, 1.75));
  QPainterPath sole(QPointF(10.5, 12.0));
  sole.cubicTo({9.0, 16.0}, {12.0, 17.5}, {11.6, 20.0});
  sole.cubicTo({11.4, 24.5}, {16.8, 24.5}, {16.8, 20.0});
  sole.cubicTo({16.8, 17.0}, {19.5, 15.5}, {18.4, 11.5});
  sole.cubicTo({17.6, 9.0}, {11.6, 9.0}, {10.5, 12.0});
  painter.drawPath(sole);
  painter.setPen(Qt::NoPen);
  painter.setBrush(foot_);
  painter.drawEllipse(QPointF(10.4, 6.6), 1.9, 2.2);
  for (const QPointF& toe :
       {QPointF(13.9, 5.3), QPointF(16.4, 5.6), QPointF(18.6, 6.6), QPointF(20.3, 8.2)}) {
    painter.drawEllipse(toe, 1.2, 1.4);
  }
}

}  // namespace tarsus
