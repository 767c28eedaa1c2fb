#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
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

std::vector<TextRun> amendmentRuns(const ReportAmendment& amendment,
                                   int number,
                                   const Speech& say) {
  const QString space = QStringLiteral(" ");
  std::vector<TextRun> runs{
      {say(phrase::kAmendment, QString::number(number)), type::kCell.asBold()},
      {space + say.term(amendment.field) + say.colon() + space, type::kCell},
      {say.entered(amendment.old_value), type::kCell.asStruck()},
      {space + QChar(0x2192) + space + say.entered(amendment.new_value) + QStringLiteral(". ") +
           say(phrase::kReason) + say.colon() + space + say.entered(amendment.reason) +
           QLatin1Char('.'),
       type::kCell}};
  if (!amendment.effect.empty()) {
    runs.push_back({space + say(phrase::kEffect) + say.colon() + space +
                        QString::fromStdString(amendment.effect) + QLatin1Char('.'),
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

/// Signatures and amendments in the order of their versions and times, then the open line.
std::vector<SignatureRow> rowsOf(const ReportContent& content, const Speech& say) {
  std::vector<std::pair<std::string, SignatureRow>> timed;
  for (const ReportSignature& signature : content.signatures) {
    timed.push_back({signature.when,
                     {.version = QString::number(signature.version),
                      .what = {{say(wordsOf(signature.step)), type::kCell}},
                      .who = say.entered(signature.who),
                      .when = say.dateTime(signature.when),
                      .key = shortKey(signature.key)}});
  }
  int number = 0;
  for (const ReportAmendment& amendment : content.amendments) {
    timed.push_back({amendment.when,
                     {.version = QString::number(amendment.version),
                      .what = amendmentRuns(amendment, ++number, say),
                      .who = say.entered(amendment.who),
                      .when = say.dateTime(amendment.when),
                      .key = {}}});
  }
  std::ranges::stable_sort(timed, {}, [](const auto& row) { return row.first; });
  std::vector<SignatureRow> rows;
  for (auto& [when, row] : timed) {
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
  const double what_width = kWhoLeft - kWhatLeft - 3.0;
  const double who_width = kWhenLeft - kWhoLeft - 1.0;
  const std::vector<TextRun> who{{row.who, type::kCell}};
  const std::vector<TextRun> when{{row.when, type::kCell}};
  const double when_width = kKeyLeft - kWhenLeft - 1.0;
  double height = std::max({canvas.paragraphHeight(what_width, row.what),
                            canvas.paragraphHeight(who_width, who),
                            canvas.paragraphHeight(when_width, when)}) +
                  1.4;
  height = row.open ? std::max(height, 11.0) : height;
  flow.need(height);
  const double y = flow.y + 0.6;
  canvas.text({page::kLeft, y}, row.version, type::kCell);
  canvas.paragraph({kWhatLeft, y}, what_width, row.what);
  canvas.paragraph({kWhoLeft, y}, who_width, who);
  canvas.paragraph({kWhenLeft, y}, when_width, when);
  canvas.text({kKeyLeft, y + 0.4}, row.key, type::kSmall);
  if (row.open) {
    canvas.line({kWhoLeft, flow.y + 6.6}, {page::kRight - 5.0, flow.y + 6.6}, 0.25, ink::kBlack);
    canvas.text({kWhoLeft, flow.y + 7.0}, say(phrase::kOpenSign), type::kSmall);
  }
  canvas.frame("signature " + std::to_string(index),
               {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height;
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
