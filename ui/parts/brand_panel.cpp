#include "ui/parts/brand_panel.h"

#include "ui/parts/controls.h"
#include "ui/parts/foot_shape.h"
#include "ui/parts/mark.h"

#include <QHBoxLayout>
#include <QPainter>
#include <QVBoxLayout>

#include <cmath>

namespace tarsus {
namespace {

/// A wound's edge: an irregular closed curve of a mean radius.
QPainterPath edge(const QPointF& middle, double radius) {
  QPainterPath path;
  constexpr int kSteps = 90;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = 2.0 * 3.14159265358979 * i / kSteps;
    const double r = radius * (1.0 + 0.10 * std::sin(3 * a + 0.6) + 0.06 * std::sin(5 * a));
    const QPointF at = middle + QPointF(0.78 * r * std::cos(a), 1.15 * r * std::sin(a));
    if (i == 0) {
      path.moveTo(at);
    } else {
      path.lineTo(at);
    }
  }
  return path;
}

class ClosingWound : public QWidget {
 public:
  ClosingWound() { setMinimumSize(120, 200); }

 protected:
  void paintEvent(QPaintEvent*) override {
    const Theme& theme = Look::theme();
    const QColor line = Look::choice() == ThemeChoice::Light ? theme.on_accent : theme.text;
    const QColor bright =
        Look::choice() == ThemeChoice::Light ? QColor(0x7D, 0xF3, 0xF0) : theme.accent;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF sole = soleBox(QRectF(rect()).adjusted(4, 4, -4, -4));
    painter.setPen(QPen(line, 2.0));
    painter.drawPath(solePath(FootSide::Right, sole));
    const QPointF at(sole.left() + 0.55 * sole.width(), sole.top() + 0.275 * sole.height());
    const double unit = sole.height() / 435.0;
    painter.setPen(QPen(bright, 1.0, Qt::DashLine));
    painter.drawPath(edge(at, 42 * unit));
    painter.drawPath(edge(at, 33 * unit));
    painter.setPen(QPen(bright, 3.0));
    QColor bed = bright;
    bed.setAlphaF(0.28);
    painter.setBrush(bed);
    painter.drawPath(edge(at, 22 * unit));
  }
};

}  // namespace

BrandPanel::BrandPanel(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("brand"));
  setAttribute(Qt::WA_StyledBackground);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(64, 64, 64, 56);
  layout->setSpacing(16);
  auto* name = new QHBoxLayout;
  name->setSpacing(12);
  name->addWidget(new Mark(true));
  name->addWidget(makeLine(tr("Tarsus"), TypeRole::Title), 1);
  layout->addLayout(name);
  layout->addSpacing(32);
  layout->addWidget(new ClosingWound, 1);
  layout->addSpacing(48);
  QLabel* what = makeLabel(tr("Scan, outline, measure, compare foot wounds."), TypeRole::Title);
  layout->addWidget(what);
  layout->addSpacing(4);
  layout->addWidget(makeLabel(tr("Research software. Not a medical device; not cleared by any "
                                 "authority; must not be the sole basis of a clinical decision."),
                              TypeRole::Small));
}

}  // namespace tarsus
