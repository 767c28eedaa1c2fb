#include "ui/parts/scan_views.h"

#include "ui/look/icons.h"
#include "ui/look/look.h"
#include "ui/work/images.h"

#include <QAccessible>
#include <QLocale>
#include <QPainter>
#include <QPainterPath>

#include <cmath>

namespace tarsus {
namespace {

constexpr double kLeast_mm = 200.0;
constexpr double kNear_mm = 300.0;
constexpr double kFar_mm = 500.0;
constexpr double kMost_mm = 600.0;
constexpr QColor kStripeDark(0xD6, 0x8C, 0x1E);
constexpr QColor kStripeLight(0xF3, 0xD7, 0x9B);
constexpr QColor kSeen(0xC9, 0x8B, 0x65);
constexpr QColor kAim(0x00, 0xB8, 0xD9);
constexpr QColor kHalo(10, 20, 28, 158);

QPainterPath rounded(const QRectF& rect) {
  QPainterPath path;
  path.addRoundedRect(rect, 6.0, 6.0);
  return path;
}

/// Words on a small plate; @return its rectangle
QRectF paintTag(QPainter& painter, const QPointF& at, const QString& words) {
  painter.setFont(Look::font(TypeRole::Chip));
  const QFontMetrics metrics(painter.font());
  const QRectF box(at, QSizeF(metrics.horizontalAdvance(words) + 24, metrics.height() + 10));
  painter.setPen(Qt::NoPen);
  painter.setBrush(Look::theme().surface);
  painter.drawRoundedRect(box, 4.0, 4.0);
  painter.setPen(Look::theme().text);
  painter.drawText(box, Qt::AlignCenter, words);
  return box;
}

void paintEmptyPlace(QPainter& painter,
                     const QRectF& box,
                     const QString& icon,
                     const QString& text) {
  const double side = Look::px(32);
  const QPointF middle = box.center();
  drawIcon(painter,
           icon,
           QRectF(middle.x() - side / 2.0, middle.y() - side, side, side),
           Look::theme().text_secondary);
  painter.setFont(Look::font(TypeRole::Base));
  painter.setPen(Look::theme().text_secondary);
  painter.drawText(QRectF(box.left() + 8, middle.y() + 8, box.width() - 16, Look::px(48)),
                   Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap,
                   text);
}

}  // namespace

LivePicture::LivePicture(Kind kind, QWidget* parent) : QWidget(parent), kind_(kind) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(kind == Kind::Color ? tr("Colour picture") : tr("Depth picture"));
}

void LivePicture::setPicture(const QImage& picture) {
  picture_ = picture;
  update();
}

void LivePicture::setEmpty(const QString& icon, const QString& text) {
  icon_ = icon;
  text_ = text;
  update();
}

void LivePicture::setRange(double near_cm, double far_cm) {
  near_cm_ = near_cm;
  far_cm_ = far_cm;
}

void LivePicture::paintScale(QPainter& painter) const {
  painter.setFont(Look::font(TypeRole::Small));
  const QFontMetrics metrics(painter.font());
  const QString low = QString::number(std::lround(near_cm_));
  const QString high = tr("%1 cm").arg(std::lround(far_cm_));
  const double bar = Look::px(100);
  const double line = metrics.height();
  const double right = width() - 12.0;
  const double top = height() - 12.0 - line;
  const double high_left = right - metrics.horizontalAdvance(high);
  const QRectF box(high_left - 8 - bar, top + line / 2 - 4, bar, 8);
  painter.setPen(Qt::NoPen);
  painter.setBrush(kHalo);
  painter.drawRoundedRect(
      QRectF(box.left() - 16 - metrics.horizontalAdvance(low), top - 3, 0, line + 6)
          .united(QRectF(right, top, 6, line)),
      4,
      4);
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    painter.fillRect(QRectF(box.left() + i * bar / kSteps, box.top(), bar / kSteps, box.height()),
                     depthColor((i + 0.5) / kSteps));
  }
  painter.setPen(Qt::white);
  painter.drawText(QPointF(high_left, top + metrics.ascent()), high);
  painter.drawText(QPointF(box.left() - 8 - metrics.horizontalAdvance(low), top + metrics.ascent()),
                   low);
}

void LivePicture::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
  painter.setClipPath(rounded(QRectF(rect())));
  if (picture_.isNull()) {
    painter.fillRect(rect(), Look::theme().view);
    paintEmptyPlace(painter, QRectF(rect()), icon_, text_);
    return;
  }
  const QSizeF whole = QSizeF(picture_.size()).scaled(size(), Qt::KeepAspectRatioByExpanding);
  painter.drawImage(
      QRectF(QPointF((width() - whole.width()) / 2, (height() - whole.height()) / 2), whole),
      picture_);
  paintTag(painter, QPointF(12, 12), kind_ == Kind::Color ? tr("Colour") : tr("Depth"));
  if (kind_ == Kind::Depth) {
    paintScale(painter);
  }
}

GrowingView::GrowingView(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("The growing foot"));
}

void GrowingView::setFoot(const QImage& foot) {
  foot_ = foot;
  update();
}

void GrowingView::setOrder(const QString& icon, const QString& words) {
  if (words != order_) {
    icon_ = icon;
    order_ = words;
    describe();
  }
}

void GrowingView::setTrouble(const QString& title, const QString& text) {
  if (title != trouble_ || text != what_to_do_) {
    trouble_ = title;
    what_to_do_ = text;
    describe();
  }
}

void GrowingView::setAim(const QRectF& aim) {
  aim_ = aim;
  update();
}

void GrowingView::setEmpty(const QString& title, const QString& text) {
  empty_title_ = title;
  empty_text_ = text;
  update();
}

/// Read aloud as it changes; a lost scan at once.
void GrowingView::describe() {
  setAccessibleDescription(trouble_.isEmpty() ? order_ : trouble_ + QLatin1Char(' ') + what_to_do_);
  QAccessibleEvent told(this,
                        trouble_.isEmpty() ? QAccessible::DescriptionChanged : QAccessible::Alert);
  QAccessible::updateAccessibility(&told);
  update();
}

int GrowingView::paintTrouble(QPainter& painter) const {
  if (trouble_.isEmpty()) {
    return 0;
  }
  const Theme& theme = Look::theme();
  const QRect text_box(Look::px(76), 0, width() - Look::px(92), 4 * height());
  painter.setFont(Look::font(TypeRole::Base));
  const int lines =
      QFontMetrics(painter.font()).boundingRect(text_box, Qt::TextWordWrap, what_to_do_).height();
  const int top = Look::px(18);
  const int title = Look::px(30);
  const int tall = top + title + lines + Look::px(18);
  painter.fillRect(QRect(0, 0, width(), tall), theme.danger_weak);
  painter.fillRect(QRect(0, tall - 3, width(), 3), theme.danger);
  const double side = Look::px(32);
  drawIcon(painter,
           QStringLiteral("warning"),
           QRectF(Look::px(22), (tall - side) / 2.0, side, side),
           theme.danger_text);
  painter.setPen(theme.danger_text);
  painter.setFont(Look::font(TypeRole::Title));
  painter.drawText(QRect(text_box.left(), top - 4, text_box.width(), title + 4),
                   Qt::AlignLeft | Qt::AlignVCenter,
                   trouble_);
  painter.setPen(theme.text);
  painter.setFont(Look::font(TypeRole::Base));
  painter.drawText(QRect(text_box.left(), top + title, text_box.width(), lines + 8),
                   Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap,
                   what_to_do_);
  return tall;
}

void GrowingView::paintOrder(QPainter& painter, int top) const {
  if (order_.isEmpty() || !trouble_.isEmpty()) {
    return;
  }
  const Theme& theme = Look::theme();
  painter.setFont(Look::font(TypeRole::Heading));
  const QFontMetrics metrics(painter.font());
  const double icon = Look::px(20);
  const double wide = metrics.horizontalAdvance(order_) + icon + Look::px(52);
  const QRectF box((width() - wide) / 2.0, top + 16, wide, Look::px(44));
  painter.setPen(theme.note_edge_px > 0 ? QPen(theme.line, 2.0) : QPen(Qt::NoPen));
  painter.setBrush(theme.surface);
  painter.drawRoundedRect(box, 6.0, 6.0);
  drawIcon(painter,
           icon_,
           QRectF(box.left() + Look::px(18), box.center().y() - icon / 2, icon, icon),
           theme.text);
  painter.setPen(theme.text);
  painter.drawText(box.adjusted(Look::px(18) + icon + Look::px(10), 0, 0, 0),
                   Qt::AlignLeft | Qt::AlignVCenter,
                   order_);
}

void GrowingView::paintLegend(QPainter& painter) const {
  painter.setFont(Look::font(TypeRole::Small));
  const QFontMetrics metrics(painter.font());
  const QString names[] = {tr("Seen well"), tr("Seen little")};
  const double swatch = Look::px(18);
  double wide = 12.0;
  for (const QString& name : names) {
    wide += swatch + 8 + metrics.horizontalAdvance(name) + 20;
  }
  const QRectF box(16, height() - 16.0 - Look::px(34), wide, Look::px(34));
  painter.setPen(Qt::NoPen);
  painter.setBrush(Look::theme().surface);
  painter.drawRoundedRect(box, 4.0, 4.0);
  double x = box.left() + 12;
  for (int i = 0; i < 2; ++i) {
    const QRectF square(x, box.center().y() - swatch / 2, swatch, swatch);
    painter.setPen(Qt::NoPen);
    painter.setBrush(i == 0 ? kSeen : kStripeLight);
    painter.drawRoundedRect(square, 3.0, 3.0);
    if (i == 1) {
      painter.save();
      painter.setClipPath(rounded(square));
      painter.setPen(QPen(kStripeDark, 3.5));
      for (int k = -1; k < 4; ++k) {
        painter.drawLine(QPointF(square.left() + k * 7 - 4, square.bottom()),
                         QPointF(square.left() + k * 7 + swatch - 4, square.top()));
      }
      painter.restore();
    }
    x += swatch + 8;
    painter.setPen(Look::theme().text);
    painter.drawText(QPointF(x, box.center().y() + metrics.ascent() / 2.0 - 1), names[i]);
    x += metrics.horizontalAdvance(names[i]) + 20;
  }
}

void GrowingView::paintEvent(QPaintEvent*) {
  const Theme& theme = Look::theme();
  QPainter painter(this);
  painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
  painter.setClipPath(rounded(QRectF(rect())));
  painter.fillRect(rect(), theme.view);
  const int top = paintTrouble(painter);
  if (foot_.isNull()) {
    const QRectF place = QRectF(rect()).adjusted(24, top, -24, 0);
    painter.setFont(Look::font(TypeRole::Title));
    painter.setPen(theme.text);
    painter.drawText(
        QRectF(place.left(), place.center().y() - Look::px(40), place.width(), Look::px(40)),
        Qt::AlignCenter,
        empty_title_);
    painter.setFont(Look::font(TypeRole::Base));
    painter.setPen(theme.text_secondary);
    painter.drawText(QRectF(place.left(), place.center().y() + 4, place.width(), Look::px(64)),
                     Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap,
                     empty_text_);
  } else {
    const QRectF room = QRectF(rect()).adjusted(8, top + Look::px(64), -8, -Look::px(56));
    const QSizeF shown = QSizeF(foot_.size()).scaled(room.size(), Qt::KeepAspectRatio);
    const QRectF at(room.center() - QPointF(shown.width() / 2, shown.height() / 2), shown);
    painter.drawImage(at, foot_);
    if (!trouble_.isEmpty() && !aim_.isEmpty()) {
      const QRectF frame(at.left() + aim_.left() * at.width(),
                         at.top() + aim_.top() * at.height(),
                         aim_.width() * at.width(),
                         aim_.height() * at.height());
      QPen pen(kHalo, 5.6);
      painter.setBrush(Qt::NoBrush);
      painter.setPen(pen);
      painter.drawRoundedRect(frame, 6, 6);
      pen = QPen(kAim, 4.0);
      pen.setDashPattern({4.0, 2.5});
      painter.setPen(pen);
      painter.drawRoundedRect(frame, 6, 6);
      paintTag(painter, frame.bottomLeft() + QPointF(0, 8), tr("Point the camera here"));
    }
    paintLegend(painter);
  }
  paintOrder(painter, top);
}

DistanceGauge::DistanceGauge(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("Distance"));
}

QSize DistanceGauge::sizeHint() const { return {Look::px(164), Look::px(360)}; }
QSize DistanceGauge::minimumSizeHint() const { return {Look::px(156), Look::px(170)}; }

void DistanceGauge::setDistance(std::optional<double> mm) {
  const QString before = words();
  mm_ = mm;
  if (words() != before) {
    setAccessibleDescription(words());
  }
  update();
}

QString DistanceGauge::words() const {
  if (!mm_) {
    return tr("nothing in the middle of the picture");
  }
  const QString cm = tr("%1 centimetres").arg(std::lround(*mm_ / 10.0));
  return *mm_ < kNear_mm  ? tr("%1, too close").arg(cm)
         : *mm_ > kFar_mm ? tr("%1, too far").arg(cm)
                          : tr("%1, good").arg(cm);
}

void DistanceGauge::paintEvent(QPaintEvent*) {
  const Theme& theme = Look::theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double left = Look::px(52);
  const double wide = Look::px(28);
  const QRectF scale(left, 8, wide, height() - 16);
  const auto y = [&](double mm) {
    return scale.top() + scale.height() * (mm - kLeast_mm) / (kMost_mm - kLeast_mm);
  };
  painter.setPen(theme.note_edge_px > 0 ? QPen(theme.line, 2.0) : QPen(Qt::NoPen));
  painter.setBrush(theme.sunk);
  painter.drawRoundedRect(scale, 4.0, 4.0);
  QColor band = theme.accent;
  band.setAlpha(80);
  painter.fillRect(QRectF(left, y(kNear_mm), wide, y(kFar_mm) - y(kNear_mm)), band);
  painter.setPen(QPen(theme.accent, 2.0));
  for (const double mm : {kNear_mm, kFar_mm}) {
    painter.drawLine(QPointF(left, y(mm)), QPointF(left + wide, y(mm)));
  }
  for (int cm = 20; cm <= 60; cm += 10) {
    const bool edge = cm == 30 || cm == 50;
    painter.setFont(Look::font(edge ? TypeRole::Chip : TypeRole::Small));
    painter.setPen(edge ? theme.text : theme.text_secondary);
    painter.drawText(QRectF(0, y(10.0 * cm) - 10, left - 8, 20),
                     Qt::AlignRight | Qt::AlignVCenter,
                     QLocale().toString(cm));
  }
  if (!mm_) {
    return;
  }
  const bool good = *mm_ >= kNear_mm && *mm_ <= kFar_mm;
  const QColor ink = good ? theme.text : theme.danger_text;
  const double at = y(qBound(kLeast_mm, *mm_, kMost_mm));
  painter.setPen(QPen(ink, 3.0));
  painter.drawLine(QPointF(left - 4, at), QPointF(left + wide + 4, at));
  painter.setPen(Qt::NoPen);
  painter.setBrush(ink);
  painter.drawPolygon(QPolygonF({QPointF(left + wide + 3, at),
                                 QPointF(left + wide + 14, at - 8),
                                 QPointF(left + wide + 14, at + 8)}));
  painter.setPen(ink);
  painter.setFont(Look::font(TypeRole::Heading));
  painter.drawText(QRectF(left + wide + 19, at - 16, width() - left - wide - 19, 32),
                   Qt::AlignLeft | Qt::AlignVCenter,
                   *mm_ > kMost_mm + 50.0 ? tr("over %1 cm").arg(std::lround(kMost_mm / 10.0))
                                          : tr("%1 cm").arg(std::lround(*mm_ / 10.0)));
}

}  // namespace tarsus
