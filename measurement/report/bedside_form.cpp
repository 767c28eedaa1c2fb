#include "measurement/report/bedside_form.h"

#include "measurement/report/changes.h"
#include "measurement/report/key_values.h"
#include "measurement/report/no_scan.h"
#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/pictures.h"
#include "measurement/report/rows.h"

#include <algorithm>
#include <array>
#include <set>

namespace tarsus {
namespace {

constexpr double kPictureSide = kCloseSide * 4.0 / 3.0;  // 2 : 1 where page 1 has 1.5 : 1
constexpr double kAnswerLeft = page::kLeft + 32.0;
constexpr double kRow = 8.4;
const TextStyle kGreat{30, 36, true, ink::kBlack};
const TextStyle kGreatUnit{13, 36, false, ink::kBlack};

QString dot() { return QStringLiteral(u" \u00B7 "); }

/// Whose wound, large. @return bottom [mm]
double identity(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const ReportRecord& record = *content.record;
  const double badge_left = stateBadge(canvas, content, {page::kRight, top_mm});
  const TextStyle who{12, 15, true, ink::kBlack};
  const TextStyle line{10, 13, false, ink::kBlack};
  double y = top_mm;
  y += canvas.paragraph({page::kLeft, y},
                        badge_left - page::kLeft,
                        {{shortEntered(record.patient_name, say) + QStringLiteral("  "), who},
                         {say(phrase::kBorn, say.date(record.birth_date)) + dot() +
                              say(phrase::kId, say.entered(record.patient_id)),
                          line}});
  y += canvas.paragraph(
      {page::kLeft, y}, page::kContentWidth, {{woundLine(content, say), line.asBold()}});
  const int number = content.visits.empty() ? 1 : content.visits.back().number;
  const int count = std::max<int>(number, static_cast<int>(content.visits.size()));
  const QString visit = say(phrase::kVisit) + QLatin1Char(' ') +
                        say(phrase::kVisitOf, QString::number(number), QString::number(count)) +
                        dot() + say.dateTime(record.visit_time) + dot() +
                        say.entered(record.scanned_by);
  y += canvas.paragraph({page::kLeft, y}, page::kContentWidth, {{visit, line}});
  canvas.frame("identity", {page::kLeft, top_mm, page::kContentWidth, y - top_mm});
  return y + 2.4;
}

/// Interval, change and share under a great number. @return bottom [mm]
double lookBack(PageCanvas& canvas,
                const ReportContent& content,
                const MeasurementRow& row,
                const QRectF& cell) {
  const Speech& say = canvas.speech();
  const TextStyle line{9, 11.5, false, ink::kBlack};
  double y = cell.top();
  y += canvas.paragraph(
      {cell.left(), y},
      cell.width(),
      {{row.interval.isEmpty() ? say(phrase::kNoInterval) : say(phrase::kNinetyFive, row.interval),
        line}});
  const ReportVisit* previous = previousVisit(content);
  if (previous == nullptr) {
    return y;
  }
  const ChangeCells cells = changeCells(content, row, say);
  const QString visit = QString::number(previous->number);
  if (!cells.compared) {
    y += canvas.paragraph(
        {cell.left(), y}, cell.width(), {{say(phrase::kNotComparable, visit), line}});
    return y;
  }
  QString amount = cells.change;
  double x = cell.left();
  TextStyle style = line.in(cells.detectable ? ink::kBlack : ink::kFaint);
  if (cells.detectable) {
    drawTriangle(canvas, {x, y + 0.9}, cells.rises);
    amount.remove(QLatin1Char('+')).remove(QChar(0x2212));
    x += 3.6;
    style.bold = cells.rises;
  } else {
    amount = QChar(0x2248) + QStringLiteral(" ") + amount;
  }
  y += canvas.paragraph({x, y},
                        cell.right() - x,
                        {{say(phrase::kSinceVisitFrom, amount, visit, cells.previous), style}});
  return y + canvas.paragraph(
                 {cell.left(), y}, cell.width(), {{say(phrase::kOfBaseline, cells.percent), line}});
}

/// Area, volume and depth side by side. @return bottom [mm]
double greatNumbers(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const std::vector<MeasurementRow> rows = measurementRows(content.measurement, say);
  constexpr double kWidth = 55.0;
  constexpr double kStep = 61.5;
  double bottom = top_mm;
  double x = page::kLeft;
  for (const char* key : {"opening_area_mm2", "volume_mm3", "max_depth_mm"}) {
    const MeasurementRow& row = rowNamed(rows, key);
    canvas.line({x, top_mm}, {x + kWidth, top_mm}, 0.25, ink::kBlack);
    canvas.text({x, top_mm + 1.4}, row.name, type::kWords);
    double y = top_mm + 6.4;
    if (!row.reason.isEmpty()) {
      y += canvas.paragraph({x, y},
                            kWidth,
                            {{say(phrase::kNotMeasurable) + QLatin1Char('\n'), type::kTitle},
                             {row.reason, type::kCell}});
    } else {
      canvas.text({x, y}, row.value, kGreat.in(row.below_limit ? ink::kFaint : ink::kBlack));
      canvas.text({x + canvas.widthOf(row.value, kGreat) + 1.4, y + 2.2}, row.unit, kGreatUnit);
      y = lookBack(canvas, content, row, {x, y + 12.4, kWidth, 20.0});
    }
    canvas.frame(std::string("key ") + key, {x, top_mm, kWidth, y - top_mm});
    bottom = std::max(bottom, y);
    x += kStep;
  }
  return bottom + 2.4;
}

/// Both close views as large as the page is wide. @return bottom [mm]
double views(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  const double room = page::kContentWidth - 2.0 * kPictureSide - 1.4;
  const QRectF left(page::kLeft, top_mm, kPictureSide, kPictureSide);
  const QRectF right = left.translated(kPictureSide + 1.4, 0.0);
  textureView(canvas, content, left);
  depthView(canvas, content, right);
  canvas.frame("texture", left);
  canvas.frame("depth map", right);
  if (content.depth_scale_end_mm > 0.0) {
    depthLegend(canvas, content, {right.right() + 1.6, top_mm + 8.0, 2.8, kPictureSide - 16.0});
    canvas.frame("depth legend", {right.right(), top_mm, room, kPictureSide});
  }
  const double y = legendLine(canvas, content, {left.left(), left.bottom() + 1.0});
  const double scale = closePrintScale(content) * kPictureSide / kCloseSide;
  canvas.text({left.left(), y}, closeCaption(content, say, scale), type::kCaption.in(ink::kGrey));
  canvas.frame("legend", {left.left(), left.bottom() + 1.0, 160.0, y + 3.6 - left.bottom() - 1.0});
  return y + 4.6;
}

class Rows {
 public:
  Rows(PageCanvas& canvas, double top_mm) : canvas_(canvas), y_(top_mm) {}

  [[nodiscard]] double y() const { return y_; }

  /// Name at the left, what is known at its right.
  void said(const QString& name, const std::vector<TextRun>& runs) {
    begin(name, canvas_.paragraphHeight(page::kRight - kAnswerLeft, runs));
    canvas_.paragraph({kAnswerLeft, y_ + 1.8}, page::kRight - kAnswerLeft, runs);
    end();
  }
  /// Boxes to tick; what does not fit one line is left out by the caller.
  void boxes(const QString& name, const QStringList& labels) {
    begin(name, 0.0);
    double x = kAnswerLeft;
    for (const QString& label : labels) {
      x = box(x, label);
    }
    end();
  }
  void nextVisit() {
    const Speech& say = canvas_.speech();
    begin(say(phrase::kNextVisit), 0.0);
    const QString blanks = QStringLiteral("____ / ____ / ________");
    canvas_.text({kAnswerLeft, y_ + 1.8}, blanks, type::kWords);
    double x = kAnswerLeft + canvas_.widthOf(blanks, type::kWords) + 5.0;
    canvas_.text({x, y_ + 1.8}, say(phrase::kWithScan), type::kWords);
    x += canvas_.widthOf(say(phrase::kWithScan), type::kWords) + 4.0;
    x = box(x, say(phrase::kYes));
    box(x, say(phrase::kNo));
    end();
  }
  [[nodiscard]] double widthOfBox(const QString& label) const {
    return 5.4 + canvas_.widthOf(label, type::kWords) + 5.0;
  }

 private:
  void begin(const QString& name, double text_mm) {
    height_ = std::max(kRow, text_mm + 3.4);
    canvas_.paragraph({page::kLeft, y_ + 2.0},
                      kAnswerLeft - page::kLeft - 2.0,
                      {{name, {8.5, 10, false, ink::kGrey}}});
    canvas_.frame("form " + std::to_string(count_++),
                  {page::kLeft, y_, page::kContentWidth, height_});
  }
  void end() {
    y_ += height_;
    canvas_.line({page::kLeft, y_}, {page::kRight, y_}, 0.18, ink::kRule);
  }
  double box(double x, const QString& label) {
    canvas_.edge({x, y_ + 2.2, 3.8, 3.8}, 0.3, ink::kBlack);
    canvas_.text({x + 5.4, y_ + 1.8}, label, type::kWords);
    return x + widthOfBox(label);
  }

  PageCanvas& canvas_;
  double y_ = 0.0;
  double height_ = kRow;
  int count_ = 0;
};

QString findingOf(const ReportContent& content, const std::string& name) {
  for (const auto& [row, value] : content.findings.rows) {
    if (row == name) {
      return QString::fromStdString(value);
    }
  }
  return {};
}

QString underminingWords(const ReportContent& content, const Speech& say) {
  const ReportFindings& findings = content.findings;
  QStringList parts;
  const auto add = [&](const Phrase& name, const std::vector<ClockRange>& ranges, bool recorded) {
    if (!recorded || ranges.empty()) {
      parts << say(name) + say.colon() + say(recorded ? phrase::kNone : phrase::kNotRecorded);
    }
    for (const ClockRange& range : ranges) {
      const QString from = say.number(range.from_clock, 0);
      const QString to = say.number(range.to_clock, 0);
      parts << say(name) + say.colon() +
                   say(phrase::kOClock, from == to ? from : from + QChar(0x2013) + to) +
                   QLatin1Char(' ') + say.number(0.1 * range.depth_mm, 1) +
                   QStringLiteral(u"\u00A0cm");
    }
  };
  add(phrase::kUndermining, findings.undermining, findings.undermining_recorded);
  add(phrase::kTunnel, findings.tunnels, findings.tunnels_recorded);
  return parts.join(dot());
}

QString tissueWords(const ReportContent& content, const Speech& say) {
  constexpr std::array kNames{"granulation", "slough", "necrosis", "epithelium", "other"};
  QStringList parts;
  if (!content.visits.empty() && content.visits.back().tissue) {
    const TissueShares& tissue = *content.visits.back().tissue;
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      if (tissue.percent[i] > 0) {
        parts << say.term(kNames[i]) + QLatin1Char(' ') +
                     say.percent(QString::number(tissue.percent[i]));
      }
    }
  } else {
    parts << say(phrase::kTissueNot);
  }
  for (const char* name : {"exudate_amount", "exudate_type", "exudate_odour"}) {
    const std::string value = findingOf(content, name).toStdString();
    parts << say.term(name) + say.colon() +
                 (value.empty() ? say(phrase::kNotRecorded) : say.term(value));
  }
  return parts.join(dot());
}

/// What the record still lacks, as boxes of one line; the rest is in the record.
QStringList missingLabels(const Rows& rows, const ReportContent& content, const Speech& say) {
  const std::set<std::string> kOwnRow{
      "dressing", "offloading", "exudate_amount", "exudate_type", "exudate_odour"};
  QStringList all;
  if (!content.findings.undermining_recorded) {
    all << say(phrase::kUndermining);
  }
  if (!content.findings.tunnels_recorded) {
    all << say(phrase::kTunnel);
  }
  for (const auto& [name, value] : content.findings.rows) {
    if (value.empty() && !kOwnRow.contains(name)) {
      all << say.term(name);
    }
  }
  QStringList shown;
  double room = page::kRight - kAnswerLeft + 5.0;
  for (const QString& label : all) {
    room -= rows.widthOfBox(label);
    if (room < 0.0) {
      break;
    }
    shown << label;
  }
  return shown;
}

QString otherWords(const OtherWound& wound, const Speech& say) {
  QStringList parts;
  const std::vector<MeasurementRow> rows = measurementRows(wound.measurement, say);
  for (const char* key : {"opening_area_mm2", "volume_mm3", "max_depth_mm"}) {
    const MeasurementRow& row = rowNamed(rows, key);
    parts << (row.reason.isEmpty()
                  ? row.value + QChar(QChar::Nbsp) + row.unit +
                        (row.interval.isEmpty()
                             ? QString()
                             : QStringLiteral(" (") + row.interval + QLatin1Char(')'))
                  : row.name + QLatin1Char(' ') + say(phrase::kNotMeasurable) + say.colon() +
                        row.reason);
  }
  return parts.join(dot());
}

double formRows(PageCanvas& canvas, const ReportContent& content, double top_mm) {
  const Speech& say = canvas.speech();
  canvas.line({page::kLeft, top_mm}, {page::kRight, top_mm}, 0.25, ink::kBlack);
  Rows rows(canvas, top_mm);
  const TextStyle text = type::kWords;
  rows.said(say.term("undermining"), {{underminingWords(content, say), text}});
  rows.said(say(phrase::kTissueExudate), {{tissueWords(content, say), text}});
  const auto signs = content.findings.infection_signs;
  rows.said(
      say(phrase::kInfectionSigns),
      {{signs ? say.sentence(std::to_string(*signs) + " of 5") : say(phrase::kNotRecorded), text}});
  for (std::size_t i = 0; i < std::min<std::size_t>(2, content.other_wounds.size()); ++i) {
    const OtherWound& wound = content.other_wounds[i];
    rows.said(say(phrase::kWoundName, QString::number(wound.wound_number)) + QLatin1Char(' ') +
                  say.term(wound.site),
              {{otherWords(wound, say), type::kCell}});
  }
  if (const QStringList missing = missingLabels(rows, content, say); !missing.isEmpty()) {
    rows.boxes(say(phrase::kStillMissing), missing);
  }
  const auto choice = [&](const char* name, const QStringList& labels) {
    const QString known = findingOf(content, name);
    known.isEmpty() ? rows.boxes(say.term(name), labels)
                    : rows.said(say.term(name), {{shortTerm(known.toStdString(), say), text}});
  };
  choice("dressing",
         {say(phrase::kFoam),
          say(phrase::kAlginate),
          say(phrase::kHydrofibre),
          say(phrase::kOtherBox)});
  choice("offloading",
         {say(phrase::kCast),
          say(phrase::kWalker),
          say(phrase::kFelt),
          say(phrase::kShoe),
          say(phrase::kNone)});
  rows.nextVisit();
  return rows.y();
}

/// Lines for the hand, as many as fit.
void handLines(PageCanvas& canvas, double top_mm) {
  const Speech& say = canvas.speech();
  const TextStyle label{8.5, 10, false, ink::kGrey};
  const double split = page::kLeft + 116.0;
  const double bottom = canvas.contentBottom();
  if (bottom - top_mm < 14.0) {
    return;
  }
  canvas.text({page::kLeft, top_mm + 1.8}, say(phrase::kByHand), label);
  canvas.text({split, top_mm + 1.8}, say(phrase::kNameTimeSign), label);
  double y = top_mm + 13.0;
  for (; y <= bottom; y += 8.0) {
    canvas.line({page::kLeft, y}, {split - 8.0, y}, 0.2, ink::kGrey);
    canvas.line({split, y}, {page::kRight, y}, 0.2, ink::kGrey);
  }
  canvas.frame("by hand", {page::kLeft, top_mm, page::kContentWidth, y - 8.0 - top_mm});
}

}  // namespace

void bedsideForm(PageCanvas& canvas, const ReportContent& content) {
  double y = pageHead(canvas, content);
  y = identity(canvas, content, y);
  y = greatNumbers(canvas, content, y);
  if (content.comparison && !content.comparison->result.registration.accepted) {
    y += canvas.paragraph({page::kLeft, y},
                          page::kContentWidth,
                          {{canvas.speech()(phrase::kNotSamePlace), type::kCell.asBold()}}) +
         1.4;
  }
  y = content.no_scan ? noScan(canvas, content, y, 70.0) : views(canvas, content, y);
  y = formRows(canvas, content, y);
  handLines(canvas, y);
  pageFoot(canvas, content, 1);
}

}  // namespace tarsus
