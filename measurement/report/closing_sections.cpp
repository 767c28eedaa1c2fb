#include "measurement/report/listed_phantoms.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/sections.h"

#include <algorithm>
#include <array>

namespace tarsus {
namespace {

constexpr std::string_view kScanHash = "Scan SHA-256";

using Pairs = std::vector<std::pair<QString, QString>>;

/// In groups of eight, so that it can be compared by eye and wraps.
QString groupedHash(const std::string& hash, const Speech& say) {
  if (hash.empty()) {
    return say(phrase::kNotRecorded);
  }
  QString text = QString::fromStdString(hash);
  for (int at = 8; at < text.size(); at += 9) {
    text.insert(at, QLatin1Char(' '));
  }
  return text;
}

void hashLine(Flow& flow, const char* name, const Phrase& label, const std::string& hash) {
  const Speech& say = flow.canvas.speech();
  paragraphOf(flow,
              name,
              {{say(label), type::kCaption.in(ink::kGrey)},
               {QLatin1Char(' ') + groupedHash(hash, say), type::kCaption}});
}

Pairs qualityPairs(const ReportContent& content, const Speech& say) {
  Pairs pairs;
  for (const auto& [name, value] : content.quality) {
    if (name == kScanHash) {
      continue;  // a line of its own
    }
    pairs.emplace_back(say.sentence(name), say.sentence(value));
  }
  pairs.emplace_back(say(phrase::kReferenceSkin),
                     content.measurement.method.empty() ? say(phrase::kNotRecorded)
                                                        : say.sentence(content.measurement.method));
  pairs.emplace_back(say(phrase::kFit4Measurement),
                     say(content.fit_for_measurement ? phrase::kYes : phrase::kNo));
  return pairs;
}

/// Two columns of names and values, filled row by row.
void qualityTable(Flow& flow) {
  constexpr double kColumn = 91.0;
  constexpr double kValueAt = 35.0;
  const Pairs pairs = qualityPairs(flow.content, flow.canvas.speech());
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

void warningsAndReasons(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  int number = 0;
  for (const std::string& reason : flow.content.refusal_reasons) {
    paragraphOf(flow,
                "refusal " + std::to_string(number++),
                {{say(phrase::kUnfitReason) + say.colon(), type::kCell.asBold()},
                 {QStringLiteral(" ") + say.sentence(reason), type::kCell}});
  }
  for (const Warning& warning : flow.content.measurement.warnings) {
    paragraphOf(flow,
                "warning " + std::to_string(number++),
                {{say(phrase::kNote), type::kCell.asBold()},
                 {QLatin1Char(' ') + say.sentence(warning.text), type::kCell}});
  }
  if (number == 0) {
    paragraphOf(flow, "warnings", {{say(phrase::kNoWarnings), type::kCell}});
  }
}

struct NoteColumn {
  QString head;
  TextLines text;
  std::size_t next = 0;  ///< the first line not yet printed
  [[nodiscard]] bool done() const { return next >= text.lines.size(); }
};

NoteColumn noteColumn(const PageCanvas& canvas,
                      const Phrase& name,
                      const ReportText& text,
                      double width_mm) {
  const Speech& say = canvas.speech();
  QStringList head{say(name)};
  if (!text.who.empty()) {
    head << QString::fromStdString(text.who);
  }
  if (!text.when.empty()) {
    head << say.dateTime(text.when);
  }
  return {head.join(QStringLiteral(u" \u00B7 ")),
          canvas.linesOf(width_mm, {{say.entered(text.text), type::kWords}})};
}

/// What section 5 and the trends had to shorten, in full.
void longTexts(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  const auto put = [&](const QString& name, const std::string& text) {
    paragraphOf(flow,
                "long text",
                {{name + say.colon(), type::kCaption.in(ink::kGrey)},
                 {QStringLiteral(" ") + QString::fromStdString(text), type::kWords}});
  };
  const ReportRecord& record = *flow.content.record;
  for (const auto& [name, value] : {std::pair(&phrase::kPatient, &record.patient_name),
                                    std::pair(&phrase::kPatient, &record.patient_id),
                                    std::pair(&phrase::kHeadWho, &record.scanned_by)}) {
    if (isLongText(*value)) {
      put(say(*name), *value);
    }
  }
  for (const auto& [name, value] : flow.content.findings.rows) {
    if (isLongText(value)) {
      put(say.term(name), value);
    }
  }
  for (const ReportEvent& event : flow.content.events) {
    if (isLongText(event.text)) {
      put(say(phrase::kEvents) + QLatin1Char(' ') + say.date(event.date), event.text);
    }
  }
}

/// Volume and depth of the listed phantoms beside what is true, and what is known of this camera.
void phantomTable(Flow& flow) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  constexpr double kRow = 4.4;
  const std::array columns{
      page::kLeft + 96.0, page::kLeft + 122.0, page::kLeft + 150.0, page::kRight - 1.0};
  const double head =
      canvas.paragraphHeight(page::kContentWidth, {{say(phrase::kPhantoms), type::kCaption}});
  const double height = head + 9.0 + kRow * static_cast<double>(kListedPhantoms.size());
  flow.need(height);
  const double start = flow.y;
  const TextStyle grey = type::kCaption.in(ink::kGrey);
  flow.y += canvas.paragraph(
      {page::kLeft, flow.y}, page::kContentWidth, {{say(phrase::kPhantoms), grey}});
  const std::array heads{
      &phrase::kTrueVolume, &phrase::kError, &phrase::kTrueDepth, &phrase::kError};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    canvas.text({columns[i], flow.y}, say(*heads[i]), grey, Qt::AlignRight);
  }
  flow.y += 4.0;
  canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.35, ink::kBlack);
  for (const ListedPhantom& phantom : kListedPhantoms) {
    const QString mm = QStringLiteral(u"\u00A0mm");
    const std::array cells{
        say.number(0.001 * phantom.true_volume_mm3, 2) + QChar(QChar::Nbsp) + say.millilitres(),
        say.percent(say.signedNumber(phantom.volume_error_percent, 1)),
        say.number(phantom.true_depth_mm, 1) + mm,
        say.signedNumber(phantom.depth_error_mm, 2) + mm};
    const TextStyle cell{8, 10, false, ink::kBlack};
    canvas.text({page::kLeft, flow.y + 0.4}, say.term(phantom.name), cell);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      canvas.text({columns[i], flow.y + 0.4}, cells[i], cell, Qt::AlignRight);
    }
    flow.y += kRow;
    canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.18, ink::kRule);
  }
  canvas.text({page::kLeft, flow.y + 0.6}, say(phrase::kNoPhantomCheck), type::kCaption);
  flow.y += 5.0;
  canvas.frame("phantoms", {page::kLeft, start, page::kContentWidth, flow.y - start});
  flow.y += 1.0;
}

}  // namespace

void notesSection(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  constexpr double kColumn = 92.0;
  constexpr double kWidth = 86.0;
  flow.need(24.0);
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 9, say(phrase::kNotesAndPlan));
  std::array<NoteColumn, 2> columns{
      noteColumn(flow.canvas, phrase::kNotes, flow.content.notes, kWidth),
      noteColumn(flow.canvas, phrase::kPlan, flow.content.plan, kWidth)};
  for (int part = 0; part == 0 || !columns[0].done() || !columns[1].done(); ++part) {
    if (part > 0) {
      flow.y = flow.turn_page();
    }
    const double top = flow.y;
    double height = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      NoteColumn& column = columns[i];
      if (column.done()) {
        continue;
      }
      const double x = page::kLeft + static_cast<double>(i) * kColumn;
      flow.canvas.paragraph({x, top}, kWidth, {{column.head, type::kCaption.in(ink::kGrey)}});
      const std::size_t first = column.next;
      column.next = paintFitting(flow, {x, top + 3.9}, column.text, first);
      height = std::max(height, column.text.line_mm * static_cast<double>(column.next - first));
    }
    flow.canvas.frame("notes " + std::to_string(part),
                      {page::kLeft, top, page::kContentWidth, height + 3.9});
    flow.y = top + height + 3.9 + page::kSectionGap;
  }
  longTexts(flow);
}

void qualitySection(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  flow.need(20.0);
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 10, say(phrase::kQuality));
  if (flow.content.no_scan) {
    if (isSigned(flow.content)) {
      hashLine(flow, "record hash", phrase::kRecordSha, flow.content.record_sha256);
    }
    paragraphOf(flow, "method", {{say(phrase::kNoScanWords), type::kCell}});
    return;
  }
  qualityTable(flow);
  for (const auto& [name, value] : flow.content.quality) {
    if (name == kScanHash) {
      hashLine(flow, "scan hash", phrase::kScanSha, value);
    }
  }
  hashLine(flow, "model hash", phrase::kModelSha, flow.content.model_sha256);
  if (isSigned(flow.content)) {
    hashLine(flow, "record hash", phrase::kRecordSha, flow.content.record_sha256);
  }
  flow.y += 0.8;
  paragraphOf(flow, "method", {{say(phrase::kMethodText), type::kCell}});
  warningsAndReasons(flow);
  phantomTable(flow);
}

void aboutSection(Flow& flow) {
  const Speech& say = flow.canvas.speech();
  flow.y += page::kSectionGap - 1.0;
  flow.need(22.0);
  flow.y += sectionHead(flow.canvas, {page::kLeft, flow.y}, 12, say(phrase::kWhatThisIs));
  QString text = say(phrase::kResearchUse) + say.gap() + say(phrase::kRecords);
  if (!isSigned(flow.content)) {
    text += say.gap() + say(phrase::kDraftUntil);
  }
  paragraphOf(flow, "disclaimer", {{text, type::kCell}});
}

}  // namespace tarsus
