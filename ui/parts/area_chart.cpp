#include "ui/parts/area_chart.h"

#include "ui/look/look.h"

#include <QLocale>
#include <QPainter>
#include <QPainterPath>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// Three equal steps of 1, 2, 3 or 5 of a decade that reach over the greatest value.
double stepFor(double greatest) {
  const double least = std::max(greatest, 1e-3) / 3.0;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 3.0, 5.0}) {
    if (step * decade >= least) {
      return step * decade;
    }
  }
  return 10.0 * decade;
}

double topOf(const AreaPoint& point) { return point.high_mm2.value_or(point.area_mm2) / 100.0; }

struct Frame {
  QRectF box;
  double weeks;
  double top_cm2;
  [[nodiscard]] QPointF at(double week, double area_mm2) const {
    return {box.left() + week / weeks * box.width(),
            box.bottom() - area_mm2 / 100.0 / top_cm2 * box.height()};
  }
};

void paintAxes(QPainter& painter, const Frame& frame, double step) {
  const Theme& theme = Look::theme();
  painter.setFont(Look::font(TypeRole::Small));
  const double gap = Look::px(20);
  for (int i = 0; i <= 3; ++i) {
    const double y = frame.at(0.0, i * step * 100.0).y();
    painter.setPen(QPen(theme.line, 1.0));
    painter.drawLine(QPointF(frame.box.left(), y), QPointF(frame.box.right(), y));
    painter.setPen(theme.text_secondary);
    painter.drawText(QRectF(0, y - gap / 2, frame.box.left() - 8, gap),
                     Qt::AlignRight | Qt::AlignVCenter,
                     QLocale().toString(i * step, 'g', 3));
  }
  const int every = std::max(1, static_cast<int>(std::ceil(frame.weeks / 8.0)));
  for (int week = 0; week <= frame.weeks; week += every) {
    const double x = frame.at(week, 0.0).x();
    painter.drawText(
        QRectF(x - 30, frame.box.bottom() + 6, 60, gap), Qt::AlignCenter, QLocale().toString(week));
  }
}

void paintBand(QPainter& painter, const Frame& frame, const std::vector<AreaPoint>& points) {
  QPolygonF band;
  for (const AreaPoint& point : points) {
    band << frame.at(point.weeks, point.high_mm2.value_or(point.area_mm2));
  }
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    band << frame.at(point->weeks, point->low_mm2.value_or(point->area_mm2));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(Look::theme().accent_weak);
  painter.drawPolygon(band);
}

void paintPoints(QPainter& painter, const Frame& frame, const std::vector<AreaPoint>& points) {
  const Theme& theme = Look::theme();
  QPolygonF line;
  for (const AreaPoint& point : points) {
    line << frame.at(point.weeks, point.area_mm2);
  }
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(theme.accent, 2.5));
  painter.drawPolyline(line);
  for (const AreaPoint& point : points) {
    const QPointF at = frame.at(point.weeks, point.area_mm2);
    if (point.low_mm2 && point.high_mm2) {
      const double high = frame.at(point.weeks, *point.high_mm2).y();
      const double low = frame.at(point.weeks, *point.low_mm2).y();
      painter.setPen(QPen(theme.accent, 1.5));
      painter.drawLine(QPointF(at.x(), high), QPointF(at.x(), low));
      painter.drawLine(QPointF(at.x() - 4, high), QPointF(at.x() + 4, high));
      painter.drawLine(QPointF(at.x() - 4, low), QPointF(at.x() + 4, low));
    }
    painter.setPen(QPen(theme.accent, 2.0));
    painter.setBrush(point.draft ? theme.accent : theme.surface);
    painter.drawEllipse(at, 4.5, 4.5);
  }
}

}  // namespace

void paintSparkline(QPainter& painter, const QRectF& box, const std::vector<double>& areas_mm2) {
  if (areas_mm2.empty()) {
    return;
  }
  const double greatest = *std::max_element(areas_mm2.begin(), areas_mm2.end());
  const double least =
      std::min(*std::min_element(areas_mm2.begin(), areas_mm2.end()), greatest / 2);
  const double span = std::max(greatest - least, 1e-9);
  QPolygonF line;
  const double steps = std::max<double>(1.0, static_cast<double>(areas_mm2.size()) - 1.0);
  for (std::size_t i = 0; i < areas_mm2.size(); ++i) {
    const double x = areas_mm2.size() == 1 ? 1.0 : static_cast<double>(i) / steps;
    line << QPointF(box.left() + x * box.width(),
                    box.bottom() - (areas_mm2[i] - least) / span * box.height());
  }
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(Look::theme().accent, 2.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawPolyline(line);
  painter.setPen(Qt::NoPen);
  painter.setBrush(Look::theme().accent);
  painter.drawEllipse(line.last(), 3.5, 3.5);
  painter.restore();
}

AreaChart::AreaChart(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void AreaChart::setPoints(std::vector<AreaPoint> points) {
  points_ = std::move(points);
  QStringList words;
  for (const AreaPoint& point : points_) {
    const QLocale locale;
    words << tr("week %1: %2 cm²")
                 .arg(locale.toString(point.weeks, 'g', 3),
                      locale.toString(point.area_mm2 / 100.0, 'f', 2));
  }
  setAccessibleName(tr("Area over the weeks"));
  setAccessibleDescription(words.join(QStringLiteral("; ")));
  update();
}

void AreaChart::paintEvent(QPaintEvent*) {
  if (points_.empty()) {
    return;
  }
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Theme& theme = Look::theme();
  painter.setFont(Look::font(TypeRole::Small));
  painter.setPen(theme.text_secondary);
  const double head = Look::px(28);
  painter.drawText(QRectF(Look::px(32), 0, width(), head - 6),
                   Qt::AlignLeft | Qt::AlignTop,
                   tr("Area in cm² with 95 % range"));
  painter.drawText(
      QRectF(0, 0, width(), head - 6), Qt::AlignRight | Qt::AlignTop, tr("Weeks since baseline"));
  double greatest = 0.0;
  for (const AreaPoint& point : points_) {
    greatest = std::max(greatest, topOf(point));
  }
  const double step = stepFor(greatest);
  const Frame frame{
      .box =
          QRectF(Look::px(32), head, width() - Look::px(32) - 16.0, height() - head - Look::px(32)),
      .weeks = std::max(1.0, std::ceil(points_.back().weeks + 0.5)),
      .top_cm2 = 3.0 * step};
  paintAxes(painter, frame, step);
  paintBand(painter, frame, points_);
  paintPoints(painter, frame, points_);
}

}  // namespace tarsus
