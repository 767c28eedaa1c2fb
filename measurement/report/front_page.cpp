#include "measurement/report/front_page.h"

#include "measurement/report/changes.h"
#include "measurement/report/key_values.h"
#include "measurement/report/no_scan.h"
#include "measurement/report/other_wounds.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/pictures.h"
#include "measurement/report/rows.h"
#include "measurement/report/sentence.h"

#include <QStringList>

#include <algorithm>

namespace tarsus {
namespace {

const QString& dot() {
  static const QString middle_dot = QStringLiteral(u" \u00B7 ");
  return middle_dot;
}

/// A measurement alone: who, which wound, which scan. @return bottom [mm]
double identity(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const TextStyle label = type::kCaption.in(ink::kGrey);
  canvas.text({page::kLeft, top_mm}, say(phrase::kWound), label);
  const double height =
      canvas.paragraph({page::kLeft, top_mm + 3.6},
                       118.0,
                       {{QString::fromStdString(content.title_line), type::kWound}});
  const double right = page::kRight;
  canvas.text({right, top_mm}, say(phrase::kReportMade), label, Qt::AlignRight);
  canvas.text({right, top_mm + 3.6}, say.dateTime(content.created), type::kCell, Qt::AlignRight);
  canvas.text({right, top_mm + 7.7},
              say(phrase::kProgram, QString::fromStdString(content.version)),
              type::kCell,
              Qt::AlignRight);
  const double bottom = top_mm + 3.6 + std::max(height, 8.6);
  canvas.frame("identity", {page::kLeft, top_mm, page::kContentWidth, bottom - top_mm});
  return bottom + 2.4;
}

/// "PATIENT, Paula · born 14 Mar 1958 · 68 y" and the identifier.
std::vector<TextRun> patientRuns(const ReportRecord& record, const Speech& say) {
  QString rest = dot() + say(phrase::kBorn, say.date(record.birth_date));
  if (const auto days = daysBetween(record.birth_date, record.visit_time)) {
    rest += dot() + say(phrase::kAge, QString::number(static_cast<int>(*days / 365.2425)));
  }
  return {
      {shortEntered(record.patient_name, say), type::kCell.asBold()},
      {rest, type::kCell},
      {QLatin1Char('\n') + say(phrase::kId, shortEntered(record.patient_id, say)), type::kCell}};
}

std::vector<TextRun> visitRuns(const ReportContent& content, const Speech& say) {
  const ReportRecord& record = *content.record;
  const int number = content.visits.empty() ? 1 : content.visits.back().number;
  const int count = std::max<int>(number, static_cast<int>(content.visits.size()));
  QString rest = dot() + say(phrase::kVisitOf, QString::number(number), QString::number(count));
  if (content.visits.size() > 1) {
    if (const auto days = daysBetween(content.visits.front().date, record.visit_time)) {
      rest += dot() + say(phrase::kDay, QString::number(*days));
    }
  }
  const QString time = QString::fromStdString(record.visit_time).mid(11, 5);
  const QString scanned = say(content.no_scan ? phrase::kEnteredAt : phrase::kScanned,
                              time,
                              shortEntered(record.scanned_by, say));
  return {{say.date(record.visit_time), type::kCell.asBold()},
          {rest, type::kCell},
          {QLatin1Char('\n') + scanned, type::kCell}};
}

/// State, report and version at the right. @return bottom [mm]
double stateColumn(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const ReportRecord& record = *content.record;
  stateBadge(canvas, content, {page::kRight, top_mm});
  const TextStyle style{8, 10, false, ink::kBlack};
  // A long identifier wraps in its own column, left of which the visit stands.
  constexpr double kWidth = 44.0;
  const QString id = say(phrase::kReportId, say.entered(record.report_id));
  const double x = page::kRight - std::min(kWidth, canvas.widthOf(id, style) + 0.1);
  const double id_mm = canvas.paragraph({x, top_mm + 5.2}, page::kRight - x + 0.1, {{id, style}});
  QString version = say(phrase::kVersion, QString::number(record.version));
  if (!content.amendments.empty()) {
    const auto count = static_cast<int>(content.amendments.size());
    version += say.gap() + (count == 1 ? say(phrase::kOneAmendment)
                                       : say(phrase::kAmendments, QString::number(count)));
  }
  canvas.text({page::kRight, top_mm + 5.2 + id_mm}, version, style, Qt::AlignRight);
  return top_mm + 8.7 + id_mm;
}

double woundBlock(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const ReportRecord& record = *content.record;
  canvas.text({page::kLeft, top_mm}, say(phrase::kWound), type::kCaption.in(ink::kGrey));
  double y = top_mm + 3.4;
  y += canvas.paragraph(
      {page::kLeft, y}, page::kContentWidth, {{woundLine(content, say), type::kWound}});
  QStringList facts;
  if (!record.aetiology.empty()) {
    facts << say.term(record.aetiology);
  }
  facts << say(phrase::kOnset, say.date(record.onset));
  const double half = 0.6 * page::kContentWidth;
  const double left = canvas.paragraph({page::kLeft, y}, half, {{facts.join(dot()), type::kCell}});
  const double right_room = page::kContentWidth - half - 4.0;
  const std::vector<TextRun> clinic{{QString::fromStdString(record.clinic), type::kCell}};
  const double clinic_width = canvas.widthOf(clinic.front().text, type::kCell);
  const double x = page::kRight - std::min(right_room, clinic_width + 0.1);
  const double right =
      record.clinic.empty() ? 0.0 : canvas.paragraph({x, y}, page::kRight - x + 0.2, clinic);
  return y + std::max(left, right);
}

/// The record: whose, which visit, which state. @return bottom [mm]
double recordIdentity(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  constexpr double kVisitLeft = page::kLeft + 68.0;
  const Speech& say = canvas.speech();
  const TextStyle label = type::kCaption.in(ink::kGrey);
  canvas.text({page::kLeft, top_mm}, say(phrase::kPatient), label);
  canvas.text({kVisitLeft, top_mm}, say(phrase::kVisit), label);
  const double text_top = top_mm + 3.4;
  const double patient = canvas.paragraph(
      {page::kLeft, text_top}, kVisitLeft - page::kLeft - 4.0, patientRuns(*content.record, say));
  const double visit = canvas.paragraph({kVisitLeft, text_top}, 60.0, visitRuns(content, say));
  const double state = stateColumn(canvas, content, top_mm);
  const double y = std::max(text_top + std::max(patient, visit), state) + 2.0;
  const double bottom = woundBlock(canvas, content, y);
  canvas.frame("identity", {page::kLeft, top_mm, page::kContentWidth, bottom - top_mm});
  return bottom + 2.4;
}

/// A model that must not be measured says so before any number is read. @return bottom [mm]
double unfitNotice(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  QStringList reasons;
  for (const std::string& reason : content.refusal_reasons) {
    QString text = say.sentence(reason);
    while (text.endsWith(QLatin1Char('.')) || text.endsWith(QChar(0x3002))) {
      text.chop(1);  // they are joined into one sentence
    }
    reasons << text;
  }
  const QString why = reasons.isEmpty() ? say(phrase::kNoReason) : reasons.join(say.semicolon());
  const std::vector<TextRun> runs{
      {say(phrase::kUnfitScan) + say.colon(), type::kWords.asBold()},
      {QLatin1Char(' ') + why + QLatin1Char('.') + QLatin1Char(' '), type::kWords},
      {say(phrase::kScanAgain), type::kWords.asBold()}};
  const double height = canvas.paragraphHeight(page::kContentWidth - 6.0, runs) + 3.0;
  QPainterPath box;
  box.addRect(QRectF(page::kLeft, top_mm, page::kContentWidth, height));
  canvas.path(box, QPen(ink::kBlack, 0.5));
  canvas.paragraph({page::kLeft + 3.0, top_mm + 1.5}, page::kContentWidth - 6.0, runs);
  canvas.frame("unfit", {page::kLeft, top_mm, page::kContentWidth, height});
  return top_mm + height + 3.0;
}

}  // namespace

bool frontPage(PageCanvas& canvas, const ReportContent& content) {
  const std::vector<MeasurementRow> rows = measurementRows(content.measurement, canvas.speech());
  double y = pageHead(canvas, content);
  canvas.bookmark(1, canvas.speech()(phrase::kIdentity), y);
  y = content.record ? recordIdentity(canvas, content, y) : identity(canvas, content, y);
  if (!content.fit_for_measurement) {
    y = unfitNotice(canvas, content, y);
  }
  y = keyValues(canvas, content, rows, y);
  const double words =
      canvas.paragraph({page::kLeft, y},
                       page::kContentWidth,
                       {{sentenceInWords(content, rows, canvas.speech()), type::kWords}});
  canvas.frame("sentence", {page::kLeft, y, page::kContentWidth, words});
  y += words + page::kSectionGap;
  if (content.no_scan) {
    y = noScan(canvas, content, y, 100.0) + page::kSectionGap;
    return otherWounds(canvas, content, y);
  }
  const double foot_bottom = footMap(canvas, content, {page::kLeft, y});
  const double close_bottom = closeViews(canvas, content, {page::kLeft + 37.6, y});
  y = std::max(foot_bottom, close_bottom) + page::kSectionGap;
  if (content.section && content.section->surface_mm.size() >= 2) {
    y = sectionDrawing(canvas, content, y) + page::kSectionGap;
  }
  return otherWounds(canvas, content, y);
}

}  // namespace tarsus
