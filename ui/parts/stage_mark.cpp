#include "ui/parts/stage_mark.h"

#include "ui/look/icons.h"
#include "ui/look/look.h"

#include <QPainter>

#include <cmath>

namespace tarsus {

StageMark::StageMark(QWidget* parent) : QWidget(parent) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
}

void StageMark::setKind(Kind kind) {
  kind_ = kind;
  update();
}

void StageMark::setFraction(double fraction) {
  fraction_ = fraction;
  update();
}

QSize StageMark::sizeHint() const { return {Look::px(22), Look::px(22)}; }

void StageMark::paintEvent(QPaintEvent*) {
  const Theme& theme = Look::theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double side = Look::px(20);
  const QRectF disc((width() - side) / 2.0, (height() - side) / 2.0, side, side);
  const QRectF icon = disc.adjusted(3, 3, -3, -3);
  constexpr int kTurn = 16;
  switch (kind_) {
    case Kind::ToCome:
      painter.setPen(QPen(theme.control_edge, 1.5));
      painter.drawEllipse(disc.adjusted(1, 1, -1, -1));
      break;
    case Kind::Running:
      painter.setPen(QPen(theme.line, 3.0));
      painter.drawEllipse(disc.adjusted(2, 2, -2, -2));
      painter.setPen(QPen(theme.accent, 3.0, Qt::SolidLine, Qt::FlatCap));
      painter.drawArc(disc.adjusted(2, 2, -2, -2),
                      90 * kTurn,
                      -static_cast<int>(std::lround(360.0 * kTurn * qBound(0.08, fraction_, 1.0))));
      break;
    case Kind::Done:
      painter.setPen(Qt::NoPen);
      painter.setBrush(theme.accent);
      painter.drawEllipse(disc);
      drawIcon(painter, QStringLiteral("check"), icon, theme.on_accent);
      break;
    case Kind::Checked:
      drawIcon(painter, QStringLiteral("check"), disc, theme.accent_text);
      break;
    case Kind::Waiting:
      drawIcon(painter, QStringLiteral("clock"), disc, theme.text_secondary);
      break;
    case Kind::Care:
      drawIcon(painter, QStringLiteral("warning"), disc, theme.warning_text);
      break;
    case Kind::Refused:
      drawIcon(painter, QStringLiteral("close"), disc, theme.danger_text);
      break;
  }
}

}  // namespace tarsus
