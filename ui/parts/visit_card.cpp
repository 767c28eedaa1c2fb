#include "ui/parts/visit_card.h"

#include "ui/look/icons.h"
#include "ui/look/look.h"
#include "ui/parts/chip.h"
#include "ui/parts/words.h"

#include <QLocale>
#include <QPainter>
#include <QPainterPath>
#include <QVariant>

#include <cmath>

namespace tarsus {

VisitCard::VisitCard(const VisitSummary& visit, const VisitSummary& baseline, QWidget* parent)
    : QAbstractButton(parent), visit_(visit), is_baseline_(visit.id == baseline.id) {
  setCheckable(true);
  setAutoExclusive(true);
  setCursor(Qt::PointingHandCursor);
  setProperty("ring", true);
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
  if (const auto ratio = areaRatio(baseline, visit); ratio && !is_baseline_) {
    change_ = changeText(*ratio);
  }
  const auto weeks =
      static_cast<int>(std::lround(static_cast<double>(baseline.date.daysTo(visit.date)) / 7.0));
  week_ = tr("Week %1").arg(QLocale().toString(weeks));
  if (!visit.debridement.isEmpty()) {
    week_ = tr("%1, %2", "week, what was done").arg(week_, visit.debridement);
  }
  const QString area = visit.area_mm2 ? areaText(*visit.area_mm2) : tr("area not computable");
  setAccessibleName(
      QStringList{dayMonthYear(visit.date), area, change_, week_, chipOf(visit.state).text}.join(
          QStringLiteral(", ")));
  setToolTip(week_);
}

void VisitCard::setPicture(const QImage& picture) {
  picture_ = picture;
  update();
}

QSize VisitCard::sizeHint() const { return {Look::px(192), Look::px(144) + Look::px(72)}; }

void VisitCard::paintPicture(QPainter& painter, const QRectF& box) const {
  const Theme& theme = Look::theme();
  QPainterPath clip;
  clip.addRoundedRect(box, 6.0, 6.0);
  painter.save();
  painter.setClipPath(clip);
  painter.fillRect(box, theme.view);
  if (!picture_.isNull()) {
    painter.drawImage(box, picture_);
  } else {
    const double side = Look::px(32);
    drawIcon(painter,
             QStringLiteral("foot"),
             QRectF(box.center().x() - side / 2, box.center().y() - side / 2, side, side),
             theme.control_edge);
  }
  painter.restore();
  if (isChecked()) {
    painter.setPen(QPen(theme.accent, 3.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(box.adjusted(1.5, 1.5, -1.5, -1.5), 6.0, 6.0);
  }
}

void VisitCard::paintEvent(QPaintEvent*) {
  const Theme& theme = Look::theme();
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  const double picture = Look::px(144);
  paintPicture(painter, QRectF(0, 0, width(), picture));
  const auto line =
      [&](double top, TypeRole role, const QColor& color, const QString& words, double left) {
        painter.setFont(Look::font(role));
        painter.setPen(color);
        const QFontMetrics metrics(painter.font());
        painter.drawText(
            QRectF(left, picture + Look::px(top), width() - left, Look::px(22)),
            Qt::AlignLeft | Qt::AlignVCenter,
            metrics.elidedText(words, Qt::ElideRight, static_cast<int>(width() - left)));
        return left + metrics.horizontalAdvance(words);
      };
  line(6, TypeRole::Strong, theme.text, dayMonthYear(visit_.date), 0);
  const bool says_state = visit_.state == VisitState::Draft || visit_.state == VisitState::Returned;
  if (says_state || is_baseline_) {
    const ChipLook chip = says_state ? chipOf(visit_.state) : ChipLook{tr("Baseline")};
    const QSize size = chipSize(chip);
    paintChip(painter, {width() - size.width(), static_cast<int>(picture) + Look::px(5)}, chip);
  } else {
    const double side = Look::px(16);
    drawIcon(painter,
             QStringLiteral("lock"),
             QRectF(width() - side - 2, picture + Look::px(9), side, side),
             theme.text_secondary);
  }
  const QString area = visit_.area_mm2 ? areaText(*visit_.area_mm2) : tr("not computable");
  const double after = line(28, TypeRole::Strong, theme.text, area, 0);
  line(28, TypeRole::Base, theme.text_secondary, change_, after + Look::px(6));
  line(47, TypeRole::Small, theme.text_secondary, week_, 0);
}

}  // namespace tarsus
