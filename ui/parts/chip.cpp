#include "ui/parts/chip.h"

#include "ui/look/icons.h"
#include "ui/look/look.h"

#include <QCoreApplication>
#include <QFontMetrics>
#include <QPainter>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(VisitState)
};

struct Colors {
  QColor ground;
  QColor ink;
};

Colors colorsOf(ChipTone tone) {
  const Theme& theme = Look::theme();
  switch (tone) {
    case ChipTone::Good:
      return {theme.accent_weak, theme.accent_text};
    case ChipTone::Warning:
      return {theme.warning_weak, theme.warning_text};
    case ChipTone::Danger:
      return {theme.danger_weak, theme.danger_text};
    case ChipTone::Plain:
      break;
  }
  return {theme.sunk, theme.text};
}

}  // namespace

QSize chipSize(const ChipLook& chip) {
  const QFontMetrics metrics(Look::font(TypeRole::Chip));
  const int icon = chip.icon.isEmpty() ? 0 : Look::px(20);
  return {metrics.horizontalAdvance(chip.text) + icon + Look::px(20), Look::px(24)};
}

void paintChip(QPainter& painter, const QPoint& top_left, const ChipLook& chip) {
  const Colors colors = colorsOf(chip.tone);
  const QRectF box(top_left, chipSize(chip));
  const double edge = Look::theme().note_edge_px;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(edge > 0 ? QPen(Look::theme().line, edge) : QPen(Qt::NoPen));
  painter.setBrush(colors.ground);
  painter.drawRoundedRect(
      box.adjusted(edge / 2, edge / 2, -edge / 2, -edge / 2), box.height() / 2, box.height() / 2);
  double left = box.left() + Look::px(10);
  if (!chip.icon.isEmpty()) {
    const double side = Look::px(16);
    drawIcon(painter, chip.icon, QRectF(left, box.center().y() - side / 2, side, side), colors.ink);
    left += Look::px(20);
  }
  painter.setFont(Look::font(TypeRole::Chip));
  painter.setPen(colors.ink);
  painter.drawText(QRectF(left, box.top(), box.right() - left, box.height()),
                   Qt::AlignVCenter | Qt::AlignLeft,
                   chip.text);
  painter.restore();
}

ChipLook chipOf(VisitState state) {
  switch (state) {
    case VisitState::Draft:
      return {Words::tr("Draft"), ChipTone::Warning, QStringLiteral("clock")};
    case VisitState::Signed:
      return {Words::tr("Signed"), ChipTone::Plain, {}};
    case VisitState::Returned:
      return {Words::tr("Sent back"), ChipTone::Warning, QStringLiteral("warning")};
    case VisitState::Amended:
      return {Words::tr("Amended"), ChipTone::Plain, {}};
    case VisitState::Reviewed:
      break;
  }
  return {Words::tr("Reviewed"), ChipTone::Good, QStringLiteral("check")};
}

Chip::Chip(ChipLook chip, QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
  setChip(std::move(chip));
}

void Chip::setChip(ChipLook chip) {
  chip_ = std::move(chip);
  setAccessibleName(chip_.text);
  updateGeometry();
  update();
}

void Chip::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  paintChip(painter, {0, 0}, chip_);
}

}  // namespace tarsus
