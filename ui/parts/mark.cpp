#include "ui/parts/mark.h"

#include "ui/look/look.h"

#include <QPainter>
#include <QPainterPath>

namespace tarsus {

Mark::Mark(bool on_brand, QWidget* parent) : QWidget(parent), on_brand_(on_brand) {
  setFixedSize(sizeHint());
}

void Mark::paintEvent(QPaintEvent*) {
  const Theme& theme = Look::theme();
  const bool inverted = on_brand_ && Look::choice() == ThemeChoice::Light;
  const QColor square = inverted ? theme.on_accent : theme.accent;
  const QColor foot = inverted ? theme.accent : theme.on_accent;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(square);
  painter.drawRoundedRect(rect(), 6.0, 6.0);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(foot, 1.75));
  QPainterPath sole(QPointF(10.5, 12.0));
  sole.cubicTo({9.0, 16.0}, {12.0, 17.5}, {11.6, 20.0});
  sole.cubicTo({11.4, 24.5}, {16.8, 24.5}, {16.8, 20.0});
  sole.cubicTo({16.8, 17.0}, {19.5, 15.5}, {18.4, 11.5});
  sole.cubicTo({17.6, 9.0}, {11.6, 9.0}, {10.5, 12.0});
  painter.drawPath(sole);
  painter.setPen(Qt::NoPen);
  painter.setBrush(foot);
  painter.drawEllipse(QPointF(10.4, 6.6), 1.9, 2.2);
  for (const QPointF& toe :
       {QPointF(13.9, 5.3), QPointF(16.4, 5.6), QPointF(18.6, 6.6), QPointF(20.3, 8.2)}) {
    painter.drawEllipse(toe, 1.2, 1.4);
  }
}

}  // namespace tarsus
