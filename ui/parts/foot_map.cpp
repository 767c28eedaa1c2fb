#include "ui/parts/foot_map.h"

#include "ui/look/icons.h"
#include "ui/look/look.h"
#include "ui/parts/foot_shape.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include <algorithm>

namespace tarsus {
namespace {

constexpr double kMarkerRadius = 15.0;

}  // namespace

FootMap::FootMap(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::PointingHandCursor);
  describe();
}

void FootMap::setMarkers(std::vector<Marker> markers) {
  markers_ = std::move(markers);
  describe();
  update();
}

void FootMap::setSelected(const QString& id) {
  selected_ = id;
  update();
}

void FootMap::setProposal(FootSide side, const QString& place) {
  proposal_side_ = side;
  proposal_ = place;
  update();
}

void FootMap::setCanPlace(bool can_place) { can_place_ = can_place; }

void FootMap::describe() {
  setAccessibleName(tr("Foot map, both soles"));
  QStringList words;
  for (const Marker& marker : markers_) {
    words << marker.words;
  }
  setAccessibleDescription(words.isEmpty() ? tr("No wound placed")
                                           : words.join(QStringLiteral("; ")));
}

QRectF FootMap::soleRect(FootSide side) const {
  const double label = Look::px(30);
  const double half = width() / 2.0;
  // As the patient shows them: the right sole at the left, great toes inwards.
  const QRectF box(side == FootSide::Right ? 0.0 : half, 4.0, half, height() - label - 8.0);
  return soleBox(box.adjusted(8, 0, -8, 0));
}

QPointF FootMap::pointOf(FootSide side, const QString& place) const {
  const QRectF sole = soleRect(side);
  const QPointF middle = middleOf(side, place);
  return {sole.left() + middle.x() * sole.width(), sole.top() + middle.y() * sole.height()};
}

void FootMap::paintMarker(QPainter& painter, const Marker& marker) const {
  const Theme& theme = Look::theme();
  const QPointF at = pointOf(marker.side, marker.place);
  if (marker.id == selected_) {
    painter.setPen(QPen(theme.accent, 2.0));
    painter.setBrush(theme.surface);
    painter.drawEllipse(at, kMarkerRadius + 4.0, kMarkerRadius + 4.0);
  }
  painter.setPen(QPen(marker.healed ? theme.accent : theme.surface, 2.0));
  painter.setBrush(marker.healed ? theme.surface : theme.danger);
  painter.drawEllipse(at, kMarkerRadius, kMarkerRadius);
  const QRectF box(
      at.x() - kMarkerRadius, at.y() - kMarkerRadius, 2 * kMarkerRadius, 2 * kMarkerRadius);
  if (marker.healed) {
    drawIcon(painter, QStringLiteral("check"), box.adjusted(6, 6, -6, -6), theme.accent_text);
    return;
  }
  QFont font = Look::font(TypeRole::Strong);
  font.setPixelSize(14);
  painter.setFont(font);
  painter.setPen(Look::choice() == ThemeChoice::Light ? QColor(Qt::white) : QColor(Qt::black));
  painter.drawText(box, Qt::AlignCenter, QString::number(marker.number));
}

void FootMap::paintEvent(QPaintEvent*) {
  const Theme& theme = Look::theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  for (const FootSide side : {FootSide::Right, FootSide::Left}) {
    const QRectF sole = soleRect(side);
    painter.setPen(QPen(theme.control_edge, 1.5));
    painter.setBrush(theme.sunk);
    painter.drawPath(solePath(side, sole));
    painter.setFont(Look::font(TypeRole::Small));
    painter.setPen(theme.text_secondary);
    const double half = width() / 2.0;
    painter.drawText(
        QRectF(side == FootSide::Right ? 0 : half, height() - Look::px(26), half, Look::px(24)),
        Qt::AlignCenter,
        side == FootSide::Right ? tr("Right sole") : tr("Left sole"));
  }
  for (const Marker& marker : markers_) {
    paintMarker(painter, marker);
  }
  if (!proposal_.isEmpty()) {
    painter.setPen(QPen(theme.accent, 2.5, Qt::DashLine));
    painter.setBrush(Qt::NoBrush);
    painter.drawEllipse(pointOf(proposal_side_, proposal_), kMarkerRadius, kMarkerRadius);
  }
}

void FootMap::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) {
    return;
  }
  for (const Marker& marker : markers_) {
    const QPointF away = event->localPos() - pointOf(marker.side, marker.place);
    if (QPointF::dotProduct(away, away) <= (kMarkerRadius + 7.0) * (kMarkerRadius + 7.0)) {
      emit woundPicked(marker.id);
      return;
    }
  }
  for (const FootSide side : {FootSide::Right, FootSide::Left}) {
    const QRectF sole = soleRect(side);
    if (can_place_ && sole.adjusted(-6, -6, 6, 6).contains(event->localPos())) {
      const QPointF at((event->localPos().x() - sole.left()) / sole.width(),
                       (event->localPos().y() - sole.top()) / sole.height());
      emit placeTouched(side, placeAt(side, at));
    }
  }
}

void FootMap::keyPressEvent(QKeyEvent* event) {
  const bool back = event->key() == Qt::Key_Left || event->key() == Qt::Key_Up;
  const bool on = event->key() == Qt::Key_Right || event->key() == Qt::Key_Down;
  if (markers_.empty() || (!back && !on)) {
    QWidget::keyPressEvent(event);
    return;
  }
  const auto found = std::find_if(
      markers_.begin(), markers_.end(), [&](const Marker& m) { return m.id == selected_; });
  const auto count = static_cast<std::ptrdiff_t>(markers_.size());
  const std::ptrdiff_t at = found == markers_.end() ? 0 : found - markers_.begin();
  const std::ptrdiff_t next = (at + (on ? 1 : count - 1)) % count;
  emit woundPicked(markers_[static_cast<std::size_t>(next)].id);
}

}  // namespace tarsus
