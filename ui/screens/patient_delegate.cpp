#include "ui/screens/patient_delegate.h"

#include "ui/look/look.h"
#include "ui/parts/area_chart.h"
#include "ui/parts/chip.h"
#include "ui/parts/foot_shape.h"
#include "ui/parts/words.h"
#include "ui/screens/patient_list_model.h"
#include "ui/screens/review_model.h"

#include <QAbstractScrollArea>
#include <QPainter>
#include <QTextOption>

namespace tarsus {
namespace {

/// Left edges of the columns and the right end; names and places give way first.
struct Columns {
  int patient, wound, visit, area, line, state, end;
};

Columns columnsIn(const QRect& row) {
  const int pad = Look::px(16);
  int fixed[] = {Look::px(74), Look::px(92), Look::px(104), Look::px(130)};
  const int least = Look::px(360);
  if (row.width() - 2 * pad - fixed[0] - fixed[1] - fixed[2] - fixed[3] < least) {
    fixed[2] = 0;  // the line since the start gives way to names and places
  }
  const int rest = row.width() - 2 * pad - fixed[0] - fixed[1] - fixed[2] - fixed[3];
  Columns c{};
  c.patient = row.left() + pad;
  c.wound = c.patient + rest * 42 / 100;
  c.visit = c.patient + rest;
  c.area = c.visit + fixed[0];
  c.line = c.area + fixed[1];
  c.state = c.line + fixed[2];
  c.end = row.right() - pad;
  return c;
}

void text(QPainter& painter,
          const QRectF& box,
          const QString& words,
          TypeRole role,
          const QColor& color,
          int flags) {
  painter.setFont(Look::font(role));
  painter.setPen(color);
  const QFontMetrics metrics(painter.font());
  const QString fitting = metrics.elidedText(words, Qt::ElideRight, static_cast<int>(box.width()));
  painter.drawText(box, flags, fitting);
}

void paintGround(QPainter& painter, const QStyleOptionViewItem& option, bool last) {
  const Theme& theme = Look::theme();
  const bool selected = option.state.testFlag(QStyle::State_Selected);
  const bool hovered = option.state.testFlag(QStyle::State_MouseOver);
  if (selected || hovered) {
    painter.setPen(selected && theme.note_edge_px > 0 ? QPen(theme.accent, 2.0) : QPen(Qt::NoPen));
    painter.setBrush(selected ? theme.accent_weak : theme.sunk);
    painter.drawRoundedRect(QRectF(option.rect).adjusted(1, 1, -1, -1), 6.0, 6.0);
  } else if (!last) {
    painter.setPen(theme.line);
    painter.drawLine(option.rect.bottomLeft(), option.rect.bottomRight());
  }
}

void paintSite(QPainter& painter, const PatientRow& row, const QRect& box, const Columns& at) {
  const Theme& theme = Look::theme();
  if (row.site.isEmpty()) {
    text(painter,
         QRectF(at.wound, box.top(), at.visit - at.wound - 8, box.height()),
         PatientDelegate::tr("No wound placed"),
         TypeRole::Base,
         theme.text_secondary,
         Qt::AlignVCenter | Qt::AlignLeft);
    return;
  }
  const double side = box.height() - Look::px(24);
  paintMiniFoot(painter,
                QRectF(at.wound, box.top() + Look::px(12), Look::px(36), side),
                row.side,
                row.place,
                row.healed);
  painter.setFont(Look::font(TypeRole::Base));
  painter.setPen(theme.text);
  QTextOption wrap(Qt::AlignVCenter | Qt::AlignLeft);
  wrap.setWrapMode(QTextOption::WordWrap);
  const double left = at.wound + Look::px(44);
  painter.setClipRect(QRectF(left, box.top(), at.visit - left - 8, box.height()));
  painter.drawText(
      QRectF(left, box.top() + 4, at.visit - left - 8, box.height() - 8), row.site, wrap);
  painter.setClipping(false);
}

void paintNumbers(QPainter& painter, const PatientRow& row, const QRect& box, const Columns& at) {
  const Theme& theme = Look::theme();
  constexpr int kFlags = Qt::AlignVCenter | Qt::AlignLeft;
  if (row.last_visit.isValid()) {
    text(painter,
         QRectF(at.visit, box.top(), at.area - at.visit - 6, box.height()),
         dayMonth(row.last_visit),
         TypeRole::Base,
         theme.text,
         kFlags);
  }
  const QString area = row.healed     ? PatientDelegate::tr("Healed")
                       : row.area_mm2 ? areaText(*row.area_mm2)
                                      : QStringLiteral(u"\u2013");
  text(painter,
       QRectF(at.area, box.top(), at.line - at.area - 6, box.height()),
       area,
       TypeRole::Strong,
       theme.text,
       kFlags);
  const double height = Look::px(18);
  if (at.line < at.state) {
    paintSparkline(
        painter,
        QRectF(
            at.line + 2, box.center().y() - height / 2, at.state - at.line - Look::px(22), height),
        row.areas_mm2);
  }
  if (row.state) {
    const ChipLook chip = chipOf(*row.state);
    paintChip(painter, {at.state, box.center().y() - chipSize(chip).height() / 2}, chip);
  }
}

}  // namespace

QSize PatientDelegate::sizeHint(const QStyleOptionViewItem&, const QModelIndex&) const {
  return {1, Look::px(72)};
}

void PatientDelegate::paint(QPainter* painter,
                            const QStyleOptionViewItem& option,
                            const QModelIndex& index) const {
  const Theme& theme = Look::theme();
  painter->save();
  painter->setRenderHint(QPainter::Antialiasing);
  paintGround(*painter, option, index.row() + 1 == index.model()->rowCount());
  const QVariant value = index.data(PatientListModel::RowRole);
  const Columns at = columnsIn(option.rect);
  if (!value.isValid()) {  // on its way
    painter->setPen(Qt::NoPen);
    painter->setBrush(theme.sunk);
    painter->drawRoundedRect(
        QRectF(at.patient, option.rect.center().y() - 8, Look::px(140), 16), 4.0, 4.0);
    painter->restore();
    return;
  }
  const auto row = value.value<PatientRow>();
  const QRectF name(
      at.patient, option.rect.top(), at.wound - at.patient - Look::px(12), option.rect.height());
  text(*painter,
       name.adjusted(0, 0, 0, -name.height() / 2 + 3),
       row.name,
       TypeRole::ListName,
       theme.text,
       Qt::AlignLeft | Qt::AlignBottom);
  text(*painter,
       name.adjusted(0, name.height() / 2 + 3, 0, 0),
       row.born_and_number,
       TypeRole::Small,
       theme.text_secondary,
       Qt::AlignLeft | Qt::AlignTop);
  paintSite(*painter, row, option.rect, at);
  paintNumbers(*painter, row, option.rect, at);
  painter->restore();
}

PatientColumns::PatientColumns(const QAbstractScrollArea* list) : list_(list) {
  Look::setFixedHeight(this, 36);
}

void PatientColumns::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const Columns at = columnsIn(QRect(0, 0, list_->viewport()->width(), height()));
  const std::pair<int, QString> names[] = {{at.patient, tr("Patient")},
                                           {at.wound, tr("Wound")},
                                           {at.visit, tr("Visit")},
                                           {at.area, tr("Area")},
                                           {at.line, tr("Since start")},
                                           {at.state, tr("State")}};
  for (const auto& [left, name] : names) {
    if (left == at.line && at.line == at.state && name == tr("Since start")) {
      continue;
    }
    painter.setFont(Look::font(TypeRole::Chip));
    painter.setPen(Look::theme().text_secondary);
    painter.drawText(
        QRectF(left, 0, width() - left, height()), Qt::AlignVCenter | Qt::AlignLeft, name);
  }
}

QSize ReviewDelegate::sizeHint(const QStyleOptionViewItem&, const QModelIndex&) const {
  return {1, Look::px(104)};
}

void ReviewDelegate::paint(QPainter* painter,
                           const QStyleOptionViewItem& option,
                           const QModelIndex& index) const {
  const Theme& theme = Look::theme();
  const auto item = index.data(ReviewModel::ItemRole).value<ReviewItem>();
  painter->save();
  painter->setRenderHint(QPainter::Antialiasing);
  paintGround(*painter, option, index.row() + 1 == index.model()->rowCount());
  const QRectF box = QRectF(option.rect).adjusted(Look::px(16), Look::px(10), -Look::px(12), 0);
  const auto line =
      [&](double top, double height, const QString& words, TypeRole role, const QColor& color) {
        text(*painter,
             QRectF(box.left(), box.top() + Look::px(top), box.width(), Look::px(height)),
             words,
             role,
             color,
             Qt::AlignLeft | Qt::AlignVCenter);
      };
  line(0, 22, item.patient, TypeRole::ListName, theme.text);
  line(21, 17, item.site, TypeRole::Small, theme.text_secondary);
  line(37, 17, item.taken, TypeRole::Small, theme.text_secondary);
  const QString area = item.area_mm2 ? areaText(*item.area_mm2) : tr("not computable");
  line(57, 24, area, TypeRole::Strong, theme.text);
  if (!item.change.isEmpty()) {
    const int after =
        QFontMetrics(Look::font(TypeRole::Strong)).horizontalAdvance(area) + Look::px(10);
    paintChip(
        *painter, QPointF(box.left() + after, box.top() + Look::px(57)).toPoint(), {item.change});
  }
  painter->restore();
}

}  // namespace tarsus
