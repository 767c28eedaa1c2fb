#include "measurement/report/page_parts.h"
#include "measurement/report/phrases.h"
#include "measurement/report/sections.h"

#include <algorithm>

namespace tarsus {
namespace {

constexpr double kPartsLeft = page::kLeft + 44.0;
constexpr double kPartsWidth = 92.0;
constexpr double kResultWidth = 38.0;

QString capitalised(QString text) {
  if (!text.isEmpty()) {
    text[0] = text[0].toUpper();
  }
  return text;
}

/// A part that is absent is answered by "no", which agrees with any noun.
QString meaningOf(const ScoreComponent& part, const Speech& say) {
  const bool english = say.language() == ReportLanguage::English;
  if (part.meaning == "none" && !english) {
    return say(phrase::kNo);
  }
  const QString said = say.sentence(part.meaning);
  return english ? QString(said).replace(QStringLiteral("cm2"), QStringLiteral("cm²")) : said;
}

/// "Site forefoot 0 · Neuropathy ? · ..."; what is missing is bold and underlined.
std::vector<TextRun> componentRuns(const ScoreResult& score, const Speech& say) {
  std::vector<TextRun> runs;
  for (const ScoreComponent& part : score.components) {
    if (!runs.empty()) {
      runs.push_back({QStringLiteral(u" \u00B7 "), type::kCell});
    }
    const QString name = capitalised(say.term(part.name));
    if (!part.points) {
      runs.push_back({name + QStringLiteral(u"\u00A0?"), type::kCell.asBold().asUnderlined()});
      continue;
    }
    runs.push_back(
        {name + QLatin1Char(' ') + meaningOf(part, say) + QLatin1Char(' '), type::kCell});
    runs.push_back({QString::number(*part.points), type::kCell.asBold()});
  }
  return runs;
}

std::vector<TextRun> resultRuns(const ScoreResult& score, const Speech& say) {
  if (!score.outcome.empty()) {
    return {{say.sentence(score.outcome), type::kCell.asBold()}};
  }
  QStringList missing;
  for (const std::vector<std::string>* names : {&score.missing, &score.unconfirmed}) {
    for (const std::string& name : *names) {
      missing << say.term(name);
    }
  }
  QString why = missing.join(QStringLiteral(", "));
  if (!why.isEmpty()) {
    why += say.colon() + say(phrase::kNotRecorded);
  } else {
    why = say.sentence(score.not_computable);
  }
  return {{say(phrase::kNotComputable), type::kCell.asBold()},
          {QLatin1Char('\n') + why, {8, 10, false, ink::kGrey}}};
}

void scoreRow(Flow& flow, const ScoreResult& score) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  const double result_left = page::kRight - kResultWidth;
  const std::vector<TextRun> title{{say.sentence(score.title), type::kCell.asBold()}};
  const std::vector<TextRun> parts = componentRuns(score, say);
  const std::vector<TextRun> result = resultRuns(score, say);
  const double height = std::max({canvas.paragraphHeight(kPartsLeft - page::kLeft - 2.0, title),
                                  canvas.paragraphHeight(kPartsWidth, parts),
                                  canvas.paragraphHeight(kResultWidth, result)}) +
                        1.2;
  flow.need(height);
  const double y = flow.y + 0.5;
  canvas.paragraph({page::kLeft, y}, kPartsLeft - page::kLeft - 2.0, title);
  canvas.paragraph({kPartsLeft, y}, kPartsWidth, parts);
  canvas.paragraph({result_left, y}, kResultWidth, result);
  canvas.frame("score " + score.score, {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height;
  canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.18, ink::kRule);
}

}  // namespace

void scoreSection(Flow& flow) {
  PageCanvas& canvas = flow.canvas;
  const Speech& say = canvas.speech();
  flow.need(flow.content.scores.empty() ? 10.0 : 26.0);  // the head stays with two rows
  headNote(flow, say(phrase::kScoresNote));
  flow.y += sectionHead(canvas, {page::kLeft, flow.y}, 6, say(phrase::kScores));
  if (flow.content.scores.empty()) {
    paragraphOf(flow, "no scores", {{say(phrase::kNoScores), type::kCell.in(ink::kGrey)}});
    return;
  }
  const TextStyle head = type::kCaption.in(ink::kGrey);
  canvas.text({page::kLeft, flow.y}, say(phrase::kScoreHead), head);
  canvas.text({kPartsLeft, flow.y}, say(phrase::kComponents), head);
  canvas.text({page::kRight - kResultWidth, flow.y}, say(phrase::kResult), head);
  flow.y += 4.2;
  canvas.line({page::kLeft, flow.y}, {page::kRight, flow.y}, 0.35, ink::kBlack);
  for (const ScoreResult& score : flow.content.scores) {
    scoreRow(flow, score);
  }
  flow.y += 0.8;
  paragraphOf(flow, "score notes", {{say(phrase::kMissingNote), type::kCaption}});
}

}  // namespace tarsus
