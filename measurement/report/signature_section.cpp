#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/rows.h"
#include "measurement/report/sections.h"

#include <algorithm>

namespace tarsus {
namespace {

struct SignatureRow {
  QString version;
  std::vector<TextRun> what;
  QString who;
  QString when;
  QString key;
  bool open = false;  ///< a line to sign on
};

constexpr double kWhatLeft = page::kLeft + 13.0;
constexpr double kWhoLeft = page::kLeft + 85.0;
constexpr double kWhenLeft = page::kLeft + 112.0;
constexpr double kKeyLeft = page::kLeft + 151.5;

/// The first and last digits of a key or hash.
QString shortKey(const std::string& key) {
  const QString text = QString::fromStdString(key);
  return text.size() <= 18 ? text : text.left(8) + QStringLiteral(u" \u2026 ") + text.right(8);
}

/// A field's name; of a score its own and the item's.
QString changedName(const std::string& field, const Speech& say) {
  const auto colon = field.find(": ");
  return colon == std::string::npos
             ? say.term(field)
             : QString::fromStdString(field.substr(0, colon)) + QStringLiteral(u" \u00B7 ") +
                   say.term(field.substr(colon + 2));
}

/// A value of the record as it is printed.
QString changedValue(const std::string& value, ChangedKind kind, const Speech& say) {
  const QString text = QString::fromStdString(value);
  if (text.isEmpty()) {
    return say(phrase::kNotRecorded);
  }
  switch (kind) {
    case ChangedKind::Word:
      return say.term(value);
    case ChangedKind::Time:
      return say.dateTime(value);
    case ChangedKind::Number: {
      const bool point =
          say.language() == ReportLanguage::English || say.language() == ReportLanguage::Chinese;
      return point ? text : QString(text).replace(QLatin1Char('.'), QLatin1Char(','));
    }
    case ChangedKind::Wound: {
      const QString number = text.section(QLatin1Char(' '), 0, 0);
      const std::string place = text.section(QLatin1Char(' '), 1).toStdString();
      return place.empty() ? text
                           : say(phrase::kWoundName, number) + QLatin1Char(' ') + say.term(place);
    }
    case ChangedKind::Text:
      break;
  }
  return text;
}

/// "greatest depth: 3.4 mm -> 3.1 mm", the old value struck through.
void addChange(std::vector<TextRun>& runs,
               const QString& name,
               const QString& from,
               const QString& to,
               const Speech& say) {
  const QString space = QStringLiteral(" ");
  runs.push_back(
      {(runs.size() > 1 ? say.semicolon() : space) + name + say.colon() + space, type::kCell});
  runs.push_back({from, type::kCell.asStruck()});
  runs.push_back({space + QChar(0x2192) + space + to, type::kCell});
}

QString measuredWords(const MeasurementRow& row, const Speech& say) {
  return row.reason.isEmpty()
             ? row.value + QChar(QChar::Nbsp) + row.unit
             : say(phrase::kNotMeasurable) + QStringLiteral(" (") + row.reason + QLatin1Char(')');
}

void addMeasured(std::vector<TextRun>& runs,
                 const ReportRemeasurement& measured,
                 const Speech& say) {
  const std::vector<MeasurementRow> now = measurementRows(measured.now, say);
  const std::vector<MeasurementRow> before =
      measured.before ? measurementRows(*measured.before, say) : std::vector<MeasurementRow>();
  for (const char* key : {"opening_area_mm2", "volume_mm3", "max_depth_mm"}) {
    const MeasurementRow& row = rowNamed(now, key);
    addChange(
        runs,
        row.name,
        before.empty() ? say(phrase::kNotRecorded) : measuredWords(rowNamed(before, key), say),
        measuredWords(row, say),
        say);
  }
}

/// What was typed, with one full stop behind it.
QString ended(const QString& text) {
  const bool has_end = !text.isEmpty() && QStringLiteral(u".!?\u3002").contains(text.back());
  return has_end ? text : text + QLatin1Char('.');
}

std::vector<TextRun> amendmentRuns(const ReportAmendment& amendment,
                                   int number,
                                   const Speech& say) {
  const QString space = QStringLiteral(" ");
  std::vector<TextRun> runs{
      {say(phrase::kAmendment, QString::number(number)), type::kCell.asBold()}};
  for (const ReportChange& change : amendment.changes) {
    addChange(runs,
              changedName(change.field, say),
              changedValue(change.old_value, change.kind, say),
              changedValue(change.new_value, change.kind, say),
              say);
  }
  if (amendment.measured) {
    addMeasured(runs, *amendment.measured, say);
  }
  if (runs.size() > 1) {
    runs.back().text += QLatin1Char('.');
  }
  runs.push_back(
      {space + say(phrase::kReason) + say.colon() + space + ended(say.entered(amendment.reason)),
       type::kCell});
  if (!amendment.effect.empty()) {
    runs.push_back({space + say(phrase::kEffect) + say.colon() + space +
                        ended(QString::fromStdString(amendment.effect)),
                    type::kCell});
  }
  return runs;
}

const Phrase& wordsOf(SignatureStep step) {
  switch (step) {
    case SignatureStep::Countersigned:
      return phrase::kCountersigned;
    case SignatureStep::Returned:
      return phrase::kReturned;
    default:
      return phrase::kWasSigned;
  }
}

std::vector<TextRun> signatureRuns(const ReportSignature& signature, const Speech& say) {
  QString text = say(wordsOf(signature.step));
  if (!signature.reason.empty()) {
    text += QStringLiteral(". ") + say(phrase::kReason) + say.colon() + QLatin1Char(' ') +
            ended(QString::fromStdString(signature.reason));
  }
  return {{text, type::kCell}};
}

/// Signatures and amendments in the order of their versions, then the open line.
std::vector<SignatureRow> rowsOf(const ReportContent& content, const Speech& say) {
  std::vector<std::pair<int, SignatureRow>> timed;
  for (const ReportSignature& signature : content.signatures) {
    timed.push_back({signature.version,
                     {.version = QString::number(signature.version),
                      .what = signatureRuns(signature, say),
                      .who = say.entered(signature.who),
                      .when = say.dateTime(signature.when),
                      .key = shortKey(signature.key)}});
  }
  int number = 0;
  for (const ReportAmendment& amendment : content.amendments) {
    timed.push_back({amendment.version,
                     {.version = QString::number(amendment.version),
                      .what = amendmentRuns(amendment, ++number, say),
                      .who = say.entered(amendment.who),
                      .when = say.dateTime(amendment.when),
                      .key = {}}});
  }
  std::ranges::stable_sort(timed, {}, [](const auto& row) { return row.first; });
  std::vector<SignatureRow> rows;
  for (auto& [version, row] : timed) {
    rows.push_back(std::move(row));
  }
  const bool reviewed = isSigned(content) && content.record->state == ReportState::Reviewed;
  if (!reviewed) {
    const Phrase& open = isSigned(content) ? phrase::kCountersigned : phrase::kWasSigned;
    rows.push_back({.version = QString::number(content.record->version),
                    .what = {{say(open), type::kCell}},
                    .who = {},
                    .when = {},
                    .key = {},
                    .open = true});
  }
  return rows;
}

void signatureRow(Flow& flow, const SignatureRow& row, int index) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  constexpr double kTooHigh_mm = 120.0;
  const TextLines what = canvas.linesOf(kWhoLeft - kWhatLeft - 3.0, row.what);
  const TextLines who = canvas.linesOf(kWhenLeft - kWhoLeft - 1.0, {{row.who, type::kCell}});
  const TextLines when = canvas.linesOf(kKeyLeft - kWhenLeft - 1.0, {{row.when, type::kCell}});
  const double side = std::max({who.height(), when.height(), row.open ? 9.6 : 0.0});
  const double height = std::max(what.height(), side);
  flow.need(1.4 + (height < kTooHigh_mm ? height : side));
  // A long text of an amendment goes on over the page's end.
  for (std::size_t first = 0; first < what.lines.size();) {
    if (first > 0) {
      flow.y = flow.turn_page();
    }
    const double y = flow.y + 0.7;
    canvas.text({page::kLeft, y}, row.version, type::kCell);
    const std::size_t next = paintFitting(flow, {kWhatLeft, y}, what, first);
    double used = what.line_mm * static_cast<double>(next - first);
    if (first == 0) {
      used = std::max(used, side);
      canvas.paint({kWhoLeft, y}, who, 0, who.lines.size());
      canvas.paint({kWhenLeft, y}, when, 0, when.lines.size());
      canvas.text({kKeyLeft, y + 0.4}, row.key, type::kSmall);
    }
    if (row.open) {
      canvas.line({kWhoLeft, flow.y + 6.6}, {page::kRight - 5.0, flow.y + 6.6}, 0.25, ink::kBlack);
      canvas.text({kWhoLeft, flow.y + 7.0}, say(phrase::kOpenSign), type::kSmall);
    }
    const double bottom = std::min(flow.y + used + 1.4, canvas.contentBottom());
    canvas.frame("signature " + std::to_string(index),
                 {page::kLeft, flow.y, page::kContentWidth, bottom - flow.y});
    flow.y = bottom;
    first = next;
  }
  canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.18, ink::kRule);
}

void fileTable(Flow& flow) {
  if (flow.content.files.empty()) {
    return;
  }
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  constexpr double kContentLeft = page::kLeft + 27.0;
  constexpr double kSizeRight = page::kLeft + 130.0;
  constexpr double kHashLeft = page::kLeft + 137.0;
  flow.y += page::kSectionGap - 1.0;
  flow.need(22.0);
  canvas.text({page::kLeft, flow.y}, say(phrase::kFilesHead), type::kHead);
  flow.y += 5.2;
  const TextStyle head = type::kCaption.in(ink::kGrey);
  canvas.text({page::kLeft, flow.y}, say(phrase::kHeadFile), head);
  canvas.text({kContentLeft, flow.y}, say(phrase::kHeadContent), head);
  canvas.text({kSizeRight, flow.y}, say(phrase::kHeadSize), head, Qt::AlignRight);
  canvas.text({kHashLeft, flow.y}, QStringLiteral("SHA-256"), head);
  flow.y += 4.2;
  canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.35, ink::kBlack);
  for (const ReportFile& file : flow.content.files) {
    const std::vector<TextRun> name{{QString::fromStdString(file.name), type::kCell}};
    const std::vector<TextRun> what{{QString::fromStdString(file.content), type::kCell}};
    const double height =
        std::max(canvas.paragraphHeight(25.0, name), canvas.paragraphHeight(78.0, what)) + 1.4;
    flow.need(height);
    canvas.paragraph({page::kLeft, flow.y + 0.6}, 25.0, name);
    canvas.paragraph({kContentLeft, flow.y + 0.6}, 78.0, what);
    canvas.text(
        {kSizeRight, flow.y + 0.6}, QString::fromStdString(file.size), type::kCell, Qt::AlignRight);
    canvas.text({kHashLeft, flow.y + 0.9}, shortKey(file.sha256), type::kSmall);
    canvas.frame("file " + file.name, {page::kLeft, flow.y, page::kContentWidth, height});
    flow.y += height;
    canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.18, ink::kRule);
  }
}

}  // namespace

void signatureSection(Flow& flow) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  flow.y += page::kSectionGap - 1.0;
  flow.need(26.0);
  flow.y += sectionHead(canvas, {page::kLeft, flow.y}, 11, say(phrase::kSignatures));
  const TextStyle head = type::kCaption.in(ink::kGrey);
  canvas.text({page::kLeft, flow.y}, say(phrase::kHeadVersion), head);
  canvas.text({kWhatLeft, flow.y}, say(phrase::kHeadWhat), head);
  canvas.text({kWhoLeft, flow.y}, say(phrase::kHeadWho), head);
  canvas.text({kWhenLeft, flow.y}, say(phrase::kHeadWhen), head);
  canvas.text({kKeyLeft, flow.y}, say(phrase::kHeadKey), head);
  flow.y += 4.2;
  canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.35, ink::kBlack);
  int index = 0;
  for (const SignatureRow& row : rowsOf(flow.content, say)) {
    signatureRow(flow, row, index++);
  }
  if (!flow.content.amendments.empty()) {
    flow.y += 0.8;
    paragraphOf(flow, "amendment notes", {{say(phrase::kEarlierStay), type::kCaption}});
  }
  fileTable(flow);
}

}  // namespace tarsus
