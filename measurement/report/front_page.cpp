#include "measurement/report/front_page.h"

#include "measurement/report/numbers.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/pictures.h"
#include "measurement/report/rows.h"

#include <QCoreApplication>
#include <QStringList>

#include <algorithm>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(ReportFrontPage)
};

const QString& space() {
  static const QString no_break = QStringLiteral(u"\u00A0");
  return no_break;
}

const MeasurementRow& rowNamed(const std::vector<MeasurementRow>& rows, const std::string& key) {
  const auto found = std::find_if(
      rows.begin(), rows.end(), [&](const MeasurementRow& row) { return row.key == key; });
  TARSUS_REQUIRE(found != rows.end(), "the front page shows quantities of the table");
  return *found;
}

/// Who, which wound, which scan. @return bottom [mm]
double identity(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  canvas.text({page::kLeft, top_mm}, Words::tr("Wound"), type::kCaption.in(ink::kGrey));
  const double height =
      canvas.paragraph({page::kLeft, top_mm + 3.6},
                       118.0,
                       {{QString::fromStdString(content.title_line), type::kWound}});
  const double right = page::kRight;
  canvas.text(
      {right, top_mm}, Words::tr("Report made"), type::kCaption.in(ink::kGrey), Qt::AlignRight);
  canvas.text({right, top_mm + 3.6},
              QString::fromStdString(dateText(content.created)),
              type::kCell,
              Qt::AlignRight);
  canvas.text({right, top_mm + 7.7},
              Words::tr("Tarsus %1").arg(QString::fromStdString(content.version)),
              type::kCell,
              Qt::AlignRight);
  const double bottom = top_mm + 3.6 + std::max(height, 8.6);
  canvas.frame("identity", {page::kLeft, top_mm, page::kContentWidth, bottom - top_mm});
  return bottom + 2.4;
}

/// The style with the greatest size at which the text is no wider than the room.
TextStyle fitted(const PageCanvas& canvas, const QString& text, TextStyle style, double room_mm) {
  while (style.size_pt > 7.0 && canvas.widthOf(text, style) > room_mm) {
    style.size_pt -= 0.5;
  }
  return style;
}

/// Key value of one quantity in its cell, or why there is none. @return the width of its text [mm]
double keyCell(PageCanvas& canvas, const MeasurementRow& row, const QRectF& cell) {
  canvas.text(cell.topLeft(), row.name, type::kCell);
  const TextStyle small{8, 10, false, ink::kBlack};
  if (!row.reason.isEmpty()) {
    const QString words = Words::tr("not measurable");
    const TextStyle style = fitted(canvas, words, {13, 16, true, ink::kBlack}, cell.width());
    canvas.text(cell.topLeft() + QPointF(0, 6.4), words, style);
    canvas.paragraph(cell.topLeft() + QPointF(0, 12.6), cell.width(), {{row.reason, small}});
    return canvas.widthOf(words, style);
  }
  const double unit_mm = canvas.widthOf(row.unit, type::kKeyUnit) + 1.4;
  const TextStyle value = fitted(canvas, row.value, type::kKeyValue, cell.width() - unit_mm);
  const double value_mm = canvas.widthOf(row.value, value);
  const QPointF at = cell.topLeft() + QPointF(0, 3.6);
  canvas.text(at, row.value, value.in(row.below_limit ? ink::kFaint : ink::kBlack));
  const double unit_drop = 1.9 * value.size_pt / type::kKeyValue.size_pt;  // on the same baseline
  canvas.text(at + QPointF(value_mm + 1.4, unit_drop), row.unit, type::kKeyUnit);
  const QString interval = row.interval.isEmpty() ? Words::tr("no interval")
                                                  : Words::tr("95 % interval %1").arg(row.interval);
  canvas.paragraph(cell.topLeft() + QPointF(0, 14.6), cell.width(), {{interval, small}});
  return value_mm + unit_mm;
}

double keyValues(PageCanvas& canvas, const std::vector<MeasurementRow>& rows, double top_mm) {
  struct Cell {
    const char* key;
    double width_mm;
  };
  constexpr std::array kCells{Cell{"opening_area_mm2", 41.0},
                              Cell{"volume_mm3", 41.0},
                              Cell{"max_depth_mm", 37.0},
                              Cell{"length_mm", 59.0}};
  double tallest = 19.0;
  for (const Cell& cell : kCells) {  // a long reason makes the row taller, never shorter
    const MeasurementRow& row = rowNamed(rows, cell.key);
    if (!row.reason.isEmpty()) {
      tallest =
          std::max(tallest,
                   13.4 + canvas.paragraphHeight(cell.width_mm - 4.0,
                                                 {{row.reason, {8, 10, false, ink::kBlack}}}));
    }
  }
  canvas.line({page::kLeft, top_mm}, {page::kRight, top_mm}, 0.25, ink::kBlack);
  double x = page::kLeft;
  for (const Cell& cell : kCells) {
    const double inset = x > page::kLeft ? 3.0 : 0.0;
    const QRectF box(x + inset, top_mm + 1.4, cell.width_mm - inset - 1.0, tallest);
    const double used = keyCell(canvas, rowNamed(rows, cell.key), box);
    canvas.frame(std::string("key ") + cell.key,
                 {box.left(), box.top(), std::max(box.width(), used), box.height()});
    x += cell.width_mm;
    if (x < page::kRight - 1.0) {
      canvas.line({x, top_mm}, {x, top_mm + tallest + 2.4}, 0.12, ink::kRule);
    }
  }
  const double bottom = top_mm + tallest + 2.4;
  canvas.line({page::kLeft, bottom}, {page::kRight, bottom}, 0.25, ink::kBlack);
  return bottom + 3.0;
}

/// What was measured and how far to trust it, from a closed set of sentences.
QString sentence(const ReportContent& content, const std::vector<MeasurementRow>& rows) {
  QStringList missing;
  for (const MeasurementRow& row : rows) {
    if (!row.reason.isEmpty()) {
      missing << row.name.toLower();
    }
  }
  QString text = Words::tr("Measured: %1 of %2 quantities.")
                     .arg(static_cast<int>(rows.size()) - missing.size())
                     .arg(static_cast<int>(rows.size()));
  if (!missing.isEmpty()) {
    text +=
        QLatin1Char(' ') + Words::tr("Not measurable: %1.").arg(missing.join(QStringLiteral("; ")));
  }
  const MeasurementRow& mean = rowNamed(rows, "mean_depth_mm");
  if (mean.reason.isEmpty() && *content.measurement.mean_depth_mm < 4.0) {
    text += QLatin1Char(' ') +
            Words::tr("Volume ÷ area is %1; under 4 mm volume is less precise than about 5 %.")
                .arg(mean.value + space() + mean.unit);
  }
  return text;
}

/// A model that must not be measured says so before any number is read. @return bottom [mm]
double unfitNotice(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  QStringList reasons;
  for (const std::string& reason : content.refusal_reasons) {
    QString text = QString::fromStdString(reason);
    while (text.endsWith(QLatin1Char('.'))) {
      text.chop(1);  // they are joined into one sentence
    }
    reasons << text;
  }
  const QString why =
      reasons.isEmpty() ? Words::tr("no reason was recorded") : reasons.join(QStringLiteral("; "));
  const std::vector<TextRun> runs{
      {Words::tr("This scan is not fit for measurement:"), type::kWords.asBold()},
      {QLatin1Char(' ') + why + QLatin1Char('.'), type::kWords},
      {QLatin1Char(' ') + Words::tr("Do not use the numbers; scan again."), type::kWords.asBold()}};
  const double height = canvas.paragraphHeight(page::kContentWidth - 6.0, runs) + 3.0;
  QPainterPath box;
  box.addRect(QRectF(page::kLeft, top_mm, page::kContentWidth, height));
  canvas.path(box, QPen(ink::kBlack, 0.5));
  canvas.paragraph({page::kLeft + 3.0, top_mm + 1.5}, page::kContentWidth - 6.0, runs);
  canvas.frame("unfit", {page::kLeft, top_mm, page::kContentWidth, height});
  return top_mm + height + 3.0;
}

}  // namespace

void frontPage(PageCanvas& canvas, const ReportContent& content) {
  const std::vector<MeasurementRow> rows = measurementRows(content.measurement);
  double y = pageHead(canvas, content);
  y = identity(canvas, content, y);
  if (!content.fit_for_measurement) {
    y = unfitNotice(canvas, content, y);
  }
  y = keyValues(canvas, rows, y);
  const double words = canvas.paragraph(
      {page::kLeft, y}, page::kContentWidth, {{sentence(content, rows), type::kWords}});
  canvas.frame("sentence", {page::kLeft, y, page::kContentWidth, words});
  y += words + page::kSectionGap;
  const double foot_bottom = footMap(canvas, content, {page::kLeft, y});
  const double close_bottom = closeViews(canvas, content, {page::kLeft + 37.6, y});
  y = std::max(foot_bottom, close_bottom) + page::kSectionGap;
  if (content.section && content.section->surface_mm.size() >= 2) {
    sectionDrawing(canvas, content, y);
  }
}

}  // namespace tarsus
