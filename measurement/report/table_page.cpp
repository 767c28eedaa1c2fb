#include "measurement/report/table_page.h"

#include "measurement/report/page_parts.h"
#include "measurement/report/rows.h"

#include <QCoreApplication>

#include <algorithm>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(ReportTablePage)
};

constexpr double kNameWidth = 78.0;
constexpr double kTodayRight = page::kLeft + 118.0;
constexpr double kIntervalLeft = kTodayRight + 3.0;

/// Where the next thing goes, and how a page is turned when it does not fit.
struct Flow {
  PageCanvas& canvas;
  double y;
  const std::function<double()>& turn_page;

  void need(double height_mm) {
    if (y + height_mm > page::kContentBottom) {
      y = turn_page();
    }
  }
};

void tableHead(Flow& flow) {
  const TextStyle style = type::kCaption.in(ink::kGrey);
  flow.canvas.text({page::kLeft, flow.y}, Words::tr("quantity, how measured"), style);
  flow.canvas.text(
      {kTodayRight, flow.y}, Words::tr("today"), type::kCaption.asBold(), Qt::AlignRight);
  flow.canvas.text({kIntervalLeft, flow.y}, Words::tr("95 % interval, unit"), style);
  flow.y += 4.4;
  flow.canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.35, ink::kBlack);
}

std::vector<TextRun> reasonRuns(const MeasurementRow& row) {
  return {{Words::tr("not measurable"), type::kCell.asBold()},
          {QStringLiteral(": ") + row.reason, type::kCell}};
}

double rowHeight(PageCanvas& canvas, const MeasurementRow& row) {
  double height = 8.2;
  if (!row.reason.isEmpty()) {
    const double width = page::kRight - (page::kLeft + kNameWidth);
    height = std::max(height, canvas.paragraphHeight(width, reasonRuns(row)) + 1.4);
  }
  return height;
}

void tableRow(Flow& flow, const MeasurementRow& row) {
  const double height = rowHeight(flow.canvas, row);
  flow.need(height);
  const double y = flow.y + 0.5;
  flow.canvas.text({page::kLeft, y}, row.name, row.primary ? type::kCell.asBold() : type::kCell);
  flow.canvas.text({page::kLeft, y + 3.8}, row.method, type::kSmall);
  if (!row.reason.isEmpty()) {
    const double x = page::kLeft + kNameWidth;
    flow.canvas.paragraph({x, y}, page::kRight - x, reasonRuns(row));
  } else {
    const TextStyle today =
        row.below_limit ? TextStyle{10, 11.5, false, ink::kFaint} : type::kToday;
    flow.canvas.text({kTodayRight, y}, row.value, today, Qt::AlignRight);
    const QString interval =
        row.interval.isEmpty() ? row.unit : row.interval + QStringLiteral(u"\u00A0") + row.unit;
    flow.canvas.text({kIntervalLeft, y}, interval, type::kInterval);
  }
  flow.canvas.frame("row " + row.key, {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height;
  flow.canvas.line({page::kLeft, flow.y},
                   {page::kRight, flow.y},
                   row.ends_group ? 0.25 : 0.18,
                   row.ends_group ? ink::kFaint : ink::kRule);
}

void measurements(Flow& flow, const ReportContent& content) {
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 4, Words::tr("Measurements"));
  tableHead(flow);
  bool below_limit = false;
  for (const MeasurementRow& row : measurementRows(content.measurement)) {
    tableRow(flow, row);
    below_limit = below_limit || row.below_limit;
  }
  QString notes = Words::tr(
      "Interval: 95 %, from the outline ± 0.5 mm, the skin curve ± 1 mm and the uncertainty of the "
      "model.");
  if (below_limit) {
    notes += QLatin1Char(' ') + Words::tr("“<”: not 0, but smaller than the last printed digit.");
  }
  flow.y += 1.0;
  const std::vector<TextRun> runs{{notes, type::kCaption}};
  flow.need(flow.canvas.paragraphHeight(page::kContentWidth, runs));
  const double height = flow.canvas.paragraph({page::kLeft, flow.y}, page::kContentWidth, runs);
  flow.canvas.frame("table notes", {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height + page::kSectionGap;
}

using Pairs = std::vector<std::pair<QString, QString>>;

/// In groups of eight, so that it can be compared by eye and wraps.
QString groupedHash(const std::string& hash) {
  if (hash.empty()) {
    return Words::tr("not recorded");
  }
  QString text = QString::fromStdString(hash);
  for (int at = 8; at < text.size(); at += 9) {
    text.insert(at, QLatin1Char(' '));
  }
  return text;
}

Pairs qualityPairs(const ReportContent& content) {
  Pairs pairs;
  for (const auto& [name, value] : content.quality) {
    pairs.emplace_back(QString::fromStdString(name), QString::fromStdString(value));
  }
  const QString method = QString::fromStdString(content.measurement.method);
  pairs.emplace_back(Words::tr("Reference skin"),
                     method.isEmpty() ? Words::tr("not recorded") : method);
  pairs.emplace_back(Words::tr("Fit for measurement"),
                     content.fit_for_measurement ? Words::tr("yes") : Words::tr("no"));
  return pairs;
}

/// Two columns of names and values, filled row by row.
void qualityTable(Flow& flow, const ReportContent& content) {
  constexpr double kColumn = 91.0;
  constexpr double kValueAt = 35.0;
  const Pairs pairs = qualityPairs(content);
  const double value_width = kColumn - kValueAt - 4.0;
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    double height = 0.0;
    const std::size_t count = std::min<std::size_t>(2, pairs.size() - i);
    for (std::size_t side = 0; side < count; ++side) {
      const auto& [name, value] = pairs[i + side];
      height = std::max({height,
                         flow.canvas.paragraphHeight(value_width, {{value, type::kCell}}),
                         flow.canvas.paragraphHeight(kValueAt - 2.0, {{name, type::kCell}})});
    }
    flow.need(height);
    for (std::size_t side = 0; side < count; ++side) {
      const auto& [name, value] = pairs[i + side];
      const double x = page::kLeft + static_cast<double>(side) * kColumn;
      flow.canvas.paragraph({x, flow.y}, kValueAt - 2.0, {{name, type::kCell.in(ink::kGrey)}});
      flow.canvas.paragraph({x + kValueAt, flow.y}, value_width, {{value, type::kCell}});
    }
    flow.canvas.frame("quality " + std::to_string(i / 2),
                      {page::kLeft, flow.y, page::kContentWidth, height});
    flow.y += height + 0.5;
  }
}

void paragraphOf(Flow& flow, const std::string& name, const std::vector<TextRun>& runs) {
  const double height = flow.canvas.paragraphHeight(page::kContentWidth, runs);
  flow.need(height);
  flow.canvas.paragraph({page::kLeft, flow.y}, page::kContentWidth, runs);
  flow.canvas.frame(name, {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height + 1.0;
}

void qualityAndMethod(Flow& flow, const ReportContent& content) {
  flow.need(20.0);
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 10, Words::tr("Quality and method"));
  qualityTable(flow, content);
  paragraphOf(flow,
              "model hash",
              {{Words::tr("model SHA-256"), type::kCaption.in(ink::kGrey)},
               {QLatin1Char(' ') + groupedHash(content.model_sha256), type::kCaption}});
  flow.y += 0.8;
  paragraphOf(
      flow,
      "method",
      {{Words::tr(
            "The foot was reconstructed from a depth-camera scan as one coloured surface. The "
            "wound "
            "outline was traced on it and the surface cut exactly along it. The reference skin "
            "continues the healthy skin outside the skin curve over the wound, following the "
            "curvature of the foot. Volume lies between bed and reference skin; depth is taken "
            "along the normal of the reference skin."),
        type::kCell}});
}

void warningsAndReasons(Flow& flow, const ReportContent& content) {
  int number = 0;
  for (const std::string& reason : content.refusal_reasons) {
    paragraphOf(flow,
                "refusal " + std::to_string(number++),
                {{Words::tr("Not fit for measurement:"), type::kCell.asBold()},
                 {QLatin1Char(' ') + QString::fromStdString(reason), type::kCell}});
  }
  for (const Warning& warning : content.measurement.warnings) {
    paragraphOf(flow,
                "warning " + std::to_string(number++),
                {{Words::tr("Note."), type::kCell.asBold()},
                 {QLatin1Char(' ') + QString::fromStdString(warning.text), type::kCell}});
  }
  if (number == 0) {
    paragraphOf(flow, "warnings", {{Words::tr("No warnings."), type::kCell}});
  }
}

void whatThisIs(Flow& flow) {
  flow.y += page::kSectionGap - 1.0;
  flow.need(22.0);
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 12, Words::tr("What this report is"));
  paragraphOf(flow,
              "disclaimer",
              {{researchUseText() + QLatin1Char(' ') +
                    Words::tr("It records measurements; it gives no verdict on class, severity or "
                              "healing. It is a draft until a clinician signs it."),
                type::kCell}});
}

}  // namespace

void tablePage(PageCanvas& canvas,
               const ReportContent& content,
               double top_mm,
               const std::function<double()>& turn_page) {
  Flow flow{canvas, top_mm, turn_page};
  measurements(flow, content);
  qualityAndMethod(flow, content);
  warningsAndReasons(flow, content);
  whatThisIs(flow);
}

}  // namespace tarsus
