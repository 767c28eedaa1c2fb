#include "ui/parts/icon_label.h"

#include "ui/look/look.h"

#include <QPainter>

namespace tarsus {

IconLabel::IconLabel(QString name, Tone tone, int size_at_100_percent, QWidget* parent)
    : QWidget(parent), name_(std::move(name)), tone_(tone), size_(size_at_100_percent) {
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
  setAttribute(Qt::WA_TransparentForMouseEvents);
}

QSize IconLabel::sizeHint() const { return {Look::px(size_), Look::px(size_)}; }

void IconLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const int side = std::min(width(), height());
  drawIcon(painter,
           name_,
           QRectF((width() - side) / 2.0, (height() - side) / 2.0, side, side),
           toneColor(tone_));
}

}  // namespace tarsus
