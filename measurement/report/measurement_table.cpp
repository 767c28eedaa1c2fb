#include "measurement/report/changes.h"
#include "measurement/report/key_values.h"
#include "measurement/report/no_scan.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/sections.h"

#include <algorithm>

namespace tarsus {
namespace {

/// Right edges of the columns, left of the interval's [mm].
struct Columns {
  double name_width = 78.0;
  double today = page::kLeft + 118.0;
  double interval = page::kLeft + 121.0;
  // Where an earlier visit is there to compare with:
  double previous = 125.8;
  double change = 148.8;
  double sdc = 157.0;
  double baseline = 176.4;
  double percent = page::kRight - 1.0;
};

Columns columnsOf(const ReportContent& content) {
  Columns columns;
  if (previousVisit(content) != nullptr) {
    columns.name_width = 46.0;
    columns.today = 82.9;
    columns.interval = 84.5;
  }
  return columns;
}

void tableHead(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  const Columns at = columnsOf(flow.content);
  const bool compares = previousVisit(flow.content) != nullptr;
  const TextStyle style = type::kCaption.in(ink::kGrey);
  const double line = 3.5;
  const double first = flow.y + (compares ? line : 0.0);
  flow.canvas.text({page::kLeft, first}, say(phrase::kHeadQuantity), style);
  flow.canvas.text(
      {at.today, first}, say(phrase::kHeadToday), type::kCaption.asBold(), Qt::AlignRight);
  const auto above = [&](double right, const Phrase& words, double width) {
    const std::vector<TextRun> runs{{say(words), style}};
    const double used = std::min(width, flow.canvas.widthOf(say(words), style) + 0.1);
    const double height = flow.canvas.paragraphHeight(used, runs);
    flow.canvas.paragraph({right - used, first + line - height}, used, runs);
  };
  if (!compares) {
    flow.canvas.text({at.interval, first}, say(phrase::kHeadInterval), style);
    flow.y += 4.4;
  } else {
    const std::vector<TextRun> interval{{say(phrase::kHeadInterval), style}};
    const double height = flow.canvas.paragraphHeight(22.0, interval);
    flow.canvas.paragraph({at.interval, first + line - height}, 22.0, interval);
    above(at.previous, phrase::kHeadPrevious, 18.0);
    above(at.change, phrase::kHeadChange, 20.0);
    above(at.sdc, phrase::kHeadSdc, 9.0);
    above(at.baseline, phrase::kHeadBaseline, 17.0);
    above(at.percent, phrase::kHeadPercent, 15.0);
    flow.y += 2.0 * line + 0.9;
  }
  flow.canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.35, ink::kBlack);
}

std::vector<TextRun> reasonRuns(const MeasurementRow& row, const Speech& say) {
  return {{say(phrase::kNotMeasurable), type::kCell.asBold()},
          {say.colon() + row.reason, type::kCell}};
}

/// How wide the reason of a missing value may run: up to "previous", where that is printed.
double reasonWidth(const ReportContent& content, const Columns& at) {
  const double right = previousVisit(content) != nullptr ? at.previous - 20.0 : page::kRight;
  return right - (page::kLeft + at.name_width);
}

double rowHeight(const Flow& flow, const MeasurementRow& row) {
  if (row.reason.isEmpty()) {
    return 8.2;
  }
  const Columns at = columnsOf(flow.content);
  return std::max(8.2,
                  flow.canvas.paragraphHeight(reasonWidth(flow.content, at),
                                              reasonRuns(row, flow.canvas.speech())) +
                      0.7);
}

/// "1.95-2.53 cm2"; of length and width together half the wider interval.
QString intervalOf(const Flow& flow, const MeasurementRow& row) {
  const Speech& say = flow.canvas.speech();
  const QString space(1, QChar(QChar::Nbsp));
  if (row.interval.isEmpty()) {
    return row.unit;
  }
  if (row.keys.size() == 1 || previousVisit(flow.content) == nullptr) {
    return row.interval + space + row.unit;
  }
  double half = 0.0;
  for (const std::string& key : row.keys) {
    const auto interval = measuredInterval(flow.content.measurement, key);
    half = std::max(half, interval ? 0.5 * (interval->high - interval->low) : 0.0);
  }
  return QChar(0x00B1) + space + say.number(half, row.decimals) + space + row.unit;
}

void changeColumns(Flow& flow, const MeasurementRow& row, const Columns& at, double y) {
  const ChangeCells cells = changeCells(flow.content, row, flow.canvas.speech());
  PageCanvas& canvas = flow.canvas;
  const TextStyle quiet = type::kCell.in(ink::kFaint);
  canvas.text({at.previous, y}, cells.previous, type::kCell, Qt::AlignRight);
  // A long pair of numbers takes smaller letters, never its neighbour's room.
  const auto fitted = [&](double right, double left, const QString& text) {
    TextStyle style = type::kCell;
    while (style.size_pt > type::kSmall.size_pt && canvas.widthOf(text, style) > right - left) {
      style.size_pt -= 0.5;
    }
    canvas.text({right, y}, text, style, Qt::AlignRight);
  };
  fitted(at.baseline, at.sdc + 0.8, cells.baseline);
  fitted(at.percent, at.baseline + 1.4, cells.percent);
  canvas.text({at.sdc, y}, cells.sdc, type::kInterval, Qt::AlignRight);
  if (!cells.compared) {
    canvas.text({at.change, y}, cells.change, type::kCell, Qt::AlignRight);
  } else if (!cells.detectable) {
    const QString text = QChar(0x2248) + QStringLiteral(" ") + cells.change;
    canvas.text({at.change, y}, text, quiet, Qt::AlignRight);
  } else {
    const TextStyle style = cells.rises ? type::kCell.asBold() : type::kCell;
    canvas.text({at.change, y}, cells.change, style, Qt::AlignRight);
    const double left = at.change - canvas.widthOf(cells.change, style);
    drawTriangle(canvas, {left - 2.9, y + 0.9}, cells.rises);
  }
}

void tableRow(Flow& flow, const MeasurementRow& row) {
  const Speech& say = flow.canvas.speech();
  const Columns at = columnsOf(flow.content);
  const double height = rowHeight(flow, row);
  const double y = flow.y + 0.5;
  flow.canvas.text({page::kLeft, y}, row.name, row.primary ? type::kCell.asBold() : type::kCell);
  flow.canvas.text({page::kLeft, y + 3.8}, row.method, type::kSmall);
  if (!row.reason.isEmpty()) {
    flow.canvas.paragraph(
        {page::kLeft + at.name_width, y}, reasonWidth(flow.content, at), reasonRuns(row, say));
  } else {
    const TextStyle today =
        row.below_limit ? TextStyle{10, 11.5, false, ink::kFaint} : type::kToday;
    flow.canvas.text({at.today, y}, row.value, today, Qt::AlignRight);
    flow.canvas.text({at.interval, y}, intervalOf(flow, row), type::kInterval);
  }
  if (previousVisit(flow.content) != nullptr) {
    changeColumns(flow, row, at, y);
  }
  flow.canvas.frame("row " + row.key, {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height;
  flow.canvas.line({page::kLeft, flow.y},
                   {page::kRight, flow.y},
                   row.ends_group ? 0.25 : 0.18,
                   row.ends_group ? ink::kFaint : ink::kRule);
}

/// What was typed, not measured: undermining and tunnels, in cm as the probe is read.
struct TypedRow {
  std::string key;
  QString name;
  QString value;
  QString beside;
  QString previous;
  QString baseline;
  const Phrase* how = &phrase::kByProbe;
};

QString typedLength(const std::optional<double>& mm, const Speech& say) {
  return mm ? (*mm > 0.0 ? say.number(0.1 * *mm, 1) : say(phrase::kNone)) : QString(QChar(0x2013));
}

TypedRow typedRow(const Flow& flow,
                  const Phrase& name,
                  const std::vector<ClockRange>& ranges,
                  bool recorded) {
  const Speech& say = flow.canvas.speech();
  TypedRow row{
      .key = {}, .name = say(name), .value = {}, .beside = {}, .previous = {}, .baseline = {}};
  if (!recorded) {
    row.value = say(phrase::kNotRecorded);
    return row;
  }
  if (ranges.empty()) {
    row.value = say(phrase::kNone);
    return row;
  }
  const auto deepest =
      std::ranges::max_element(ranges, {}, [](const ClockRange& range) { return range.depth_mm; });
  row.value = say.number(0.1 * deepest->depth_mm, 1);
  const QString from = say.number(deepest->from_clock, 0);
  const QString to = say.number(deepest->to_clock, 0);
  const QString hours = from == to ? from : from + QChar(0x2013) + to;
  row.beside = QStringLiteral("cm, ") + say(phrase::kOClock, hours);
  return row;
}

void drawTypedRow(Flow& flow, const TypedRow& row) {
  const Speech& say = flow.canvas.speech();
  const Columns at = columnsOf(flow.content);
  const double y = flow.y + 0.5;
  flow.canvas.text({page::kLeft, y}, row.name, type::kCell);
  flow.canvas.text({page::kLeft, y + 3.8}, say(*row.how), type::kSmall);
  const bool is_number = !row.beside.isEmpty();
  flow.canvas.text({at.today, y},
                   row.value,
                   is_number ? type::kToday : type::kCell.in(ink::kGrey),
                   Qt::AlignRight);
  flow.canvas.text({at.interval, y}, row.beside, type::kInterval);
  if (previousVisit(flow.content) != nullptr) {
    flow.canvas.text({at.previous, y}, row.previous, type::kCell, Qt::AlignRight);
    flow.canvas.text({at.baseline, y}, row.baseline, type::kCell, Qt::AlignRight);
  }
  flow.canvas.frame("row " + row.key, {page::kLeft, flow.y, page::kContentWidth, 8.2});
  flow.y += 8.2;
  flow.canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.18, ink::kRule);
}

void typedRows(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  const ReportFindings& findings = flow.content.findings;
  TypedRow undermining =
      typedRow(flow, phrase::kUndermining, findings.undermining, findings.undermining_recorded);
  TypedRow tunnel = typedRow(flow, phrase::kTunnel, findings.tunnels, findings.tunnels_recorded);
  undermining.key = "undermining";
  tunnel.key = "tunnel";
  if (const ReportVisit* previous = previousVisit(flow.content)) {
    const ReportVisit& first = *firstVisit(flow.content);
    undermining.previous = typedLength(previous->undermining_mm, say);
    undermining.baseline = typedLength(first.undermining_mm, say);
    tunnel.previous = typedLength(previous->tunnel_mm, say);
    tunnel.baseline = typedLength(first.tunnel_mm, say);
  }
  std::vector<TypedRow> read;
  if (const QString ruler = rulerText(findings, say); !ruler.isEmpty()) {
    read.push_back({"ruler", say(phrase::kRulerTyped), ruler, QStringLiteral("mm"), {}, {}});
    read.back().how = &phrase::kByRuler;
  }
  if (findings.probe_depth_mm) {
    read.push_back({"probe depth",
                    say(phrase::kProbeTyped),
                    say.number(*findings.probe_depth_mm, 1),
                    QStringLiteral("mm"),
                    {},
                    {}});
    read.back().how = &phrase::kTypedByProbe;
  }
  flow.need(16.4 + 8.2 * static_cast<double>(read.size()));
  for (const TypedRow& row : read) {
    drawTypedRow(flow, row);
  }
  drawTypedRow(flow, undermining);
  drawTypedRow(flow, tunnel);
}

/// "At visit 2 not measurable: Volume below skin (reason)", for each earlier visit of the table.
QString earlierReasons(const Flow& flow) {
  const Speech& say = flow.canvas.speech();
  QStringList sentences;
  const ReportVisit* previous = previousVisit(flow.content);
  for (const ReportVisit* visit : {previous, firstVisit(flow.content)}) {
    if (visit == nullptr ||
        (visit == previous && visit == firstVisit(flow.content) && !sentences.isEmpty())) {
      continue;
    }
    for (const auto& [key, name] :
         {std::pair("volume_mm3", phrase::kVolume), std::pair("max_depth_mm", phrase::kDepth)}) {
      const auto found = visit->measurement.not_measurable.find(key);
      if (found != visit->measurement.not_measurable.end()) {
        const QString what =
            say(name) + QStringLiteral(" (") + say.sentence(found->second) + QLatin1Char(')');
        const QString sentence = say(phrase::kAtVisitNot, QString::number(visit->number), what);
        if (!sentences.contains(sentence)) {
          sentences << sentence;
        }
      }
    }
  }
  return sentences.join(say.gap());
}

void tableNotes(Flow& flow, bool below_limit) {
  const Speech& say = flow.canvas.speech();
  QStringList notes;
  if (!flow.content.no_scan) {
    notes << say(phrase::kIntervalNote);
  }
  if (previousVisit(flow.content) != nullptr) {
    notes << say(phrase::kChangeNote);
  }
  if (below_limit) {
    notes << say(phrase::kBelowNote);
  }
  const QString earlier = earlierReasons(flow);
  if (!earlier.isEmpty()) {
    notes << earlier;
  }
  flow.y += 1.0;
  paragraphOf(flow, "table notes", {{notes.join(say.gap()), type::kCaption}});
  flow.y += page::kSectionGap - 1.0;
}

}  // namespace

void measurementSection(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  const ReportVisit* previous = previousVisit(flow.content);
  if (previous != nullptr) {
    const ReportVisit& first = *firstVisit(flow.content);
    headNote(flow,
             say(phrase::kPreviousBaseline,
                 QString::number(previous->number),
                 visitDate(*previous, say),
                 QString::number(first.number),
                 visitDate(first, say)));
  }
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 4, say(phrase::kMeasurements));
  tableHead(flow);
  bool below_limit = false;
  const std::vector<MeasurementRow> rows = measurementRows(flow.content.measurement, say);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i - 1].ends_group) {
      double group = 0.0;
      for (std::size_t k = i; k < rows.size() && (k == i || !rows[k - 1].ends_group); ++k) {
        group += rowHeight(flow, rows[k]);
      }
      if (flow.need(std::min(group, 200.0))) {
        flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 4, say(phrase::kContinued));
        tableHead(flow);
      }
    }
    tableRow(flow, rows[i]);
    below_limit = below_limit || rows[i].below_limit;
  }
  if (flow.content.record) {
    typedRows(flow);
  }
  tableNotes(flow, below_limit);
}

}  // namespace tarsus
