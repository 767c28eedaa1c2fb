#include "measurement/report/key_values.h"

#include "measurement/report/phrases.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

const TextStyle& small() {
  static const TextStyle style{8, 10, false, ink::kBlack};
  return style;
}
constexpr double kLine_mm = 3.7;
constexpr double kSpark_mm = 10.0;

/// The style with the greatest size at which the text is no wider than the room.
TextStyle fitted(const PageCanvas& canvas, const QString& text, TextStyle style, double room_mm) {
  while (style.size_pt > 7.0 && canvas.widthOf(text, style) > room_mm) {
    style.size_pt -= 0.5;
  }
  return style;
}

/// Value and unit on one baseline.
void greatNumber(PageCanvas& canvas,
                 const QRectF& cell,
                 const QString& text,
                 const MeasurementRow& row) {
  const double unit_mm = canvas.widthOf(row.unit, type::kKeyUnit) + 1.4;
  const TextStyle value = fitted(canvas, text, type::kKeyValue, cell.width() - unit_mm);
  const QPointF at = cell.topLeft() + QPointF(0, 3.6);
  canvas.text(at, text, value.in(row.below_limit ? ink::kFaint : ink::kBlack));
  const double unit_drop = 1.9 * value.size_pt / type::kKeyValue.size_pt;
  canvas.text(at + QPointF(canvas.widthOf(text, value) + 1.4, unit_drop), row.unit, type::kKeyUnit);
}

/// "triangle 0.61 since visit 3"; a rise is bold so that it is not overlooked. @return height [mm]
double changeLine(PageCanvas& canvas,
                  const QRectF& cell,
                  double y,
                  const ChangeCells& cells,
                  const QString& visit) {
  const Speech& say = canvas.speech();
  if (!cells.compared) {
    return canvas.paragraph(
        {cell.left(), y}, cell.width(), {{say(phrase::kNotComparable, visit), small()}});
  }
  if (!cells.detectable) {
    const QString text =
        QChar(0x2248) + QStringLiteral(" ") + say(phrase::kSinceVisit, cells.change, visit);
    return canvas.paragraph({cell.left(), y}, cell.width(), {{text, small().in(ink::kFaint)}});
  }
  drawTriangle(canvas, {cell.left(), y + 0.8}, cells.rises);
  QString amount = cells.change;
  amount.remove(QLatin1Char('+')).remove(QChar(0x2212));
  return canvas.paragraph(
      {cell.left() + 3.6, y},
      cell.width() - 3.6,
      {{say(phrase::kSinceVisit, amount, visit), cells.rises ? small().asBold() : small()}});
}

/// The visits' values over time: open earlier, filled today, a cross where not measurable.
void sparkline(PageCanvas& canvas,
               const ReportContent& content,
               const std::string& key,
               const QRectF& box) {
  const auto days_of = [&](const ReportVisit& visit) {
    return daysBetween(content.visits.front().date, visit.date).value_or(0);
  };
  const double span = std::max(1, days_of(content.visits.back()));
  double most = 0.0;
  for (const ReportVisit& visit : content.visits) {
    most = std::max(most, measuredValue(visit.measurement, key).value_or(0.0));
  }
  canvas.line(box.bottomLeft(), box.bottomRight(), 0.15, ink::kRule);
  std::optional<QPointF> before;
  for (std::size_t pass = 0; pass < 2; ++pass) {  // lines first, points over them
    before.reset();
    for (const ReportVisit& visit : content.visits) {
      const double x = box.left() + 1.2 + days_of(visit) / span * (box.width() - 2.4);
      const std::optional<double> value = measuredValue(visit.measurement, key);
      if (!value) {
        before.reset();
        QPainterPath cross({x - 0.7, box.bottom() - 2.0});
        cross.lineTo(x + 0.7, box.bottom() - 0.6);
        cross.moveTo(x - 0.7, box.bottom() - 0.6);
        cross.lineTo(x + 0.7, box.bottom() - 2.0);
        canvas.path(cross, QPen(ink::kBlack, 0.2));
        continue;
      }
      const double height = most > 0.0 ? *value / most * (box.height() - 1.6) : 0.0;
      const QPointF at(x, box.bottom() - height);
      if (pass == 0 && before) {
        canvas.line(*before, at, 0.3, ink::kBlack);
      }
      if (pass == 1) {
        const bool today = &visit == &content.visits.back();
        QPainterPath disc;
        disc.addEllipse(at, today ? 1.1 : 0.6, today ? 1.1 : 0.6);
        canvas.path(disc, QPen(ink::kBlack, 0.3), today ? ink::kBlack : QColor(Qt::white));
      }
      before = at;
    }
  }
}

/// One quantity in its cell, or why there is no number. @return height [mm]
double keyCell(PageCanvas& canvas,
               const ReportContent& content,
               const MeasurementRow& row,
               const QRectF& cell) {
  const Speech& say = canvas.speech();
  canvas.text(cell.topLeft(), row.name, fitted(canvas, row.name, type::kCell, cell.width()));
  double y = 14.6;
  if (!row.reason.isEmpty()) {
    const QString words = say(phrase::kNotMeasurable);
    const TextStyle style = fitted(canvas, words, {13, 16, true, ink::kBlack}, cell.width());
    canvas.text(cell.topLeft() + QPointF(0, 6.4), words, style);
    return 12.6 + canvas.paragraph(
                      cell.topLeft() + QPointF(0, 12.6), cell.width(), {{row.reason, small()}});
  }
  greatNumber(canvas, cell, row.value, row);
  const QString interval =
      row.interval.isEmpty() ? say(phrase::kNoInterval) : say(phrase::kIntervalOf, row.interval);
  y += canvas.paragraph(cell.topLeft() + QPointF(0, y), cell.width(), {{interval, small()}});
  const ReportVisit* previous = previousVisit(content);
  if (previous == nullptr || row.keys.size() > 1) {
    return y;
  }
  const ChangeCells cells = changeCells(content, row, say);
  y += changeLine(canvas, cell, cell.top() + y, cells, QString::number(previous->number));
  if (cells.percent != QString(QChar(0x2013))) {
    y += canvas.paragraph(cell.topLeft() + QPointF(0, y),
                          cell.width(),
                          {{say(phrase::kOfBaseline, cells.percent), small()}});
  }
  return y;
}

/// Area reduction since the first visit, with the published mark it is often read against.
double reductionCell(PageCanvas& canvas, const ReportContent& content, const QRectF& cell) {
  const Speech& say = canvas.speech();
  const ReportVisit& first = *firstVisit(content);
  const QString number = QString::number(first.number);
  const QString name = say(phrase::kAreaReductionSince, number);
  canvas.text(cell.topLeft(), name, fitted(canvas, name, type::kCell, cell.width()));
  const auto before = measuredValue(first.measurement, "opening_area_mm2");
  const auto now = measuredValue(content.measurement, "opening_area_mm2");
  const auto reduction = before && now ? percentAreaReduction(*before, *now) : std::nullopt;
  double y = 14.6;
  MeasurementRow row;
  row.unit = QStringLiteral("%");
  if (!reduction) {
    canvas.text(cell.topLeft() + QPointF(0, 6.4),
                say(phrase::kNotMeasurable),
                fitted(canvas, say(phrase::kNotMeasurable), type::kTitle, cell.width()));
  } else {
    greatNumber(canvas, cell, say.number(*reduction, 0), row);
  }
  std::vector<QString> lines;
  if (const auto interval = reductionInterval(first.measurement, content.measurement)) {
    lines.push_back(say(phrase::kIntervalOf, say.percent(say.interval(*interval, 1.0, 0))));
  }
  if (const auto days = daysBetween(first.date, content.visits.back().date)) {
    lines.push_back(say(phrase::kInDays, QString::number(*days)));
  }
  lines.push_back(say(phrase::kGroupMark));
  for (const QString& line : lines) {
    y += canvas.paragraph(cell.topLeft() + QPointF(0, y), cell.width(), {{line, small()}});
  }
  const QString baseline = say(phrase::kBaselineIs, number, visitDate(first, say));
  y += canvas.paragraph(
           cell.topLeft() + QPointF(0, y + 0.6), cell.width(), {{baseline, type::kSmall}}) +
       0.6;
  return y;
}

struct Cell {
  const char* key;
  double width_mm;
};

}  // namespace

void drawTriangle(PageCanvas& canvas, const QPointF& top_left_mm, bool up) {
  constexpr double kSide = 2.4;
  QPainterPath path(top_left_mm + QPointF(0.0, up ? kSide * 0.9 : 0.0));
  path.lineTo(top_left_mm + QPointF(kSide, up ? kSide * 0.9 : 0.0));
  path.lineTo(top_left_mm + QPointF(0.5 * kSide, up ? 0.0 : kSide * 0.9));
  path.closeSubpath();
  canvas.path(path, Qt::NoPen, ink::kBlack);
}

double keyValues(PageCanvas& canvas,
                 const ReportContent& content,
                 const std::vector<MeasurementRow>& rows,
                 double top_mm) {
  const bool compares = previousVisit(content) != nullptr;
  const std::array<Cell, 4> cells{Cell{"opening_area_mm2", compares ? 44.0 : 41.0},
                                  Cell{"volume_mm3", compares ? 44.0 : 41.0},
                                  Cell{"max_depth_mm", compares ? 44.0 : 37.0},
                                  Cell{"length_mm", compares ? 46.0 : 59.0}};
  canvas.line({page::kLeft, top_mm}, {page::kRight, top_mm}, 0.25, ink::kBlack);
  double tallest = 19.0;
  std::array<QRectF, 4> boxes;
  double x = page::kLeft;
  for (std::size_t i = 0; i < cells.size(); ++i) {  // a long reason makes the row taller
    const double inset = i > 0 ? 3.0 : 0.0;
    boxes[i] = {x + inset, top_mm + 1.4, cells[i].width_mm - inset - 1.0, 0.0};
    const double height = compares && i == 3
                              ? reductionCell(canvas, content, boxes[i])
                              : keyCell(canvas, content, rowNamed(rows, cells[i].key), boxes[i]);
    tallest = std::max(tallest, height + (compares && i < 3 ? kSpark_mm + 1.4 : 0.0));
    x += cells[i].width_mm;
  }
  const double bottom = top_mm + tallest + 2.4;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    boxes[i].setHeight(tallest);
    canvas.frame(std::string("key ") + cells[i].key, boxes[i]);
    if (compares && i < 3) {
      sparkline(canvas,
                content,
                cells[i].key,
                {boxes[i].left(), bottom - kSpark_mm - 1.4, 32.0, kSpark_mm});
    }
    if (i > 0) {
      const double rule = boxes[i].left() - 3.0;
      canvas.line({rule, top_mm}, {rule, bottom}, 0.12, ink::kRule);
    }
  }
  canvas.line({page::kLeft, bottom}, {page::kRight, bottom}, 0.25, ink::kBlack);
  return bottom + 3.0;
}

}  // namespace tarsus
