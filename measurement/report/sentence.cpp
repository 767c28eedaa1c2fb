#include "measurement/report/sentence.h"

#include "measurement/report/phrases.h"

namespace tarsus {
namespace {

enum Course { Fell, Rose, Same, Unknown };
constexpr std::size_t kCourses = 4;

Course courseOf(const std::optional<Change>& change) {
  if (!change || !change->detectable) {
    return Unknown;
  }
  if (!*change->detectable) {
    return Same;
  }
  return change->value < 0.0 ? Fell : Rose;
}

/// "Since visit 3 (10 days) area and volume fell and greatest depth rose, each by more than ..."
QString sinceSentence(const ReportContent& content,
                      const ReportVisit& previous,
                      const Speech& say) {
  const std::array<std::pair<const char*, Phrase>, 3> kQuantities{
      {{"opening_area_mm2", phrase::kSArea},
       {"volume_mm3", phrase::kSVolume},
       {"max_depth_mm", phrase::kSDepth}}};
  std::array<QStringList, kCourses> names;
  for (const auto& [key, name] : kQuantities) {
    names[courseOf(changeFrom(previous.measurement, content.measurement, key))] << say(name);
  }
  const std::array<std::pair<Phrase, Phrase>, kCourses> kSaid{
      {{phrase::kFellOne, phrase::kFellMany},
       {phrase::kRoseOne, phrase::kRoseMany},
       {phrase::kSameOne, phrase::kSameMany},
       {phrase::kUnknownOne, phrase::kUnknownMany}}};
  QStringList clauses;
  for (std::size_t i = 0; i < kCourses; ++i) {
    if (!names[i].isEmpty()) {
      const auto& [one, many] = kSaid[i];
      clauses << say(names[i].size() == 1 ? one : many, say.listed(names[i]));
    }
    if (i == Rose && !clauses.isEmpty()) {
      const QString joined = say.listed(clauses);
      const QString comma =
          say.language() == ReportLanguage::Chinese ? QString(QChar(0xFF0C)) : QStringLiteral(", ");
      clauses = QStringList{
          joined + comma +
          say(names[Fell].size() + names[Rose].size() == 1 ? phrase::kByMore : phrase::kEachMore)};
    }
  }
  const auto days = daysBetween(previous.date, content.visits.back().date);
  QString number = QString::number(previous.number);
  if (previous.draft) {
    number += QLatin1Char(' ') + say(phrase::kDraftVisit);
  }
  return say(phrase::kSinceSentence,
             number,
             days ? QString::number(*days) : QStringLiteral("?"),
             clauses.join(say.semicolon()));
}

/// Hours where more was lost than the last printed digit, runs of them joined: "4–5, 9".
QString hoursOfLoss(const ReportContent& content) {
  if (!content.comparison || !content.comparison->result.sectors) {
    return {};
  }
  constexpr double kPrintedLoss = 0.05;  // mm3; the table shows one decimal
  std::array<bool, 13> lost{};
  for (const SectorChange& sector : *content.comparison->result.sectors) {
    lost[static_cast<std::size_t>(sector.clock)] = sector.loss_mm3 >= kPrintedLoss;
  }
  QStringList runs;
  for (std::size_t hour = 1; hour <= 12; ++hour) {
    if (!lost[hour] || lost[hour - 1]) {
      continue;
    }
    std::size_t last = hour;
    while (last < 12 && lost[last + 1]) {
      ++last;
    }
    const QString first = QString::number(hour);
    runs << (last == hour ? first : first + QChar(0x2013) + QString::number(last));
  }
  return runs.join(QStringLiteral(", "));
}

/// Without a usable scan there are no numbers of which the place could be in doubt.
bool nothingScanned(const WoundMeasurement& measurement) {
  const auto reason = measurement.not_measurable.find("opening_area_mm2");
  return reason != measurement.not_measurable.end() && reason->second == kNoUsableScan;
}

}  // namespace

QString sentenceInWords(const ReportContent& content,
                        const std::vector<MeasurementRow>& rows,
                        const Speech& say) {
  QStringList sentences;
  if (const ReportVisit* previous = previousVisit(content)) {
    sentences << sinceSentence(content, *previous, say);
    const bool refused = content.comparison && !content.comparison->result.registration.accepted;
    if (refused || (!content.comparison && !content.why_no_comparison.empty() && !content.no_scan &&
                    !nothingScanned(previous->measurement))) {
      sentences << say(phrase::kNotSamePlace);
    }
    const QString hours = hoursOfLoss(content);
    if (!hours.isEmpty()) {
      sentences << say(
          phrase::kDeeperAt, QString::number(content.comparison->earlier_visit), hours);
    }
  } else if (content.record) {
    sentences << say(phrase::kFirstVisit);
  }
  if (content.no_scan) {
    sentences << say(phrase::kNoScanWords);
    return sentences.join(say.gap());
  }
  QStringList missing;
  for (const MeasurementRow& row : rows) {
    if (!row.reason.isEmpty()) {
      // German writes its nouns with a capital inside a sentence too.
      missing << (say.language() == ReportLanguage::German ? row.name : row.name.toLower());
    }
  }
  const auto count = static_cast<int>(rows.size());
  sentences << say(
      phrase::kMeasuredOf, QString::number(count - missing.size()), QString::number(count));
  if (!missing.isEmpty()) {
    sentences << say(phrase::kNotMeasurableList, missing.join(say.semicolon()));
  }
  const MeasurementRow& mean = rowNamed(rows, "mean_depth_mm");
  if (mean.reason.isEmpty() && *content.measurement.mean_depth_mm < 4.0) {
    sentences << say(phrase::kShallow, mean.value + QChar(QChar::Nbsp) + mean.unit);
  }
  return sentences.join(say.gap());
}

}  // namespace tarsus
