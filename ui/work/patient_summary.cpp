#include "ui/work/patient_summary.h"

#include "measurement/wound/measure.h"
#include "ui/parts/words.h"

#include <QCoreApplication>
#include <QDateTime>
#include <QLocale>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(PatientSummary)
};

using nlohmann::json;

std::string textIn(const json& fields, const char* key) {
  const auto found = fields.find(key);
  return found != fields.end() && found->is_string() ? found->get<std::string>() : std::string();
}

QString debridementWords(const json& fields) {
  const std::string when = textIn(fields, "debridement");
  if (when == "before_scan") {
    return Words::tr("debridement before scan");
  }
  return when == "after_scan" ? Words::tr("debridement after scan") : QString();
}

VisitSummary summaryOf(const Visit& visit, const Measurement* measured) {
  VisitSummary result{.id = visit.id,
                      .date = dateAt(visit.content.taken_at_ms),
                      .state = visit.state,
                      .usable_scan = visit.content.usable_scan,
                      .debridement = debridementWords(visit.content.fields),
                      .author = visit.signed_by.empty() ? visit.author : visit.signed_by};
  if (measured != nullptr) {
    const WoundMeasurement numbers = measurementFromJson(measured->numbers);
    result.area_mm2 = numbers.opening_area_mm2;
    result.perimeter_mm = numbers.perimeter_mm;
    const auto range = numbers.intervals.find("opening_area_mm2");
    if (range != numbers.intervals.end()) {
      result.area_interval_mm2 = range->second;
    }
  }
  return result;
}

QString pulses(const json& fields) {
  const std::array both{textIn(fields, "pulse_dorsalis_pedis"),
                        textIn(fields, "pulse_tibialis_posterior")};
  const auto known = std::ranges::count_if(both, [](const auto& w) { return !w.empty(); });
  const auto felt =
      std::ranges::count_if(both, [](const auto& w) { return w == "present" || w == "weak"; });
  return known == 0 ? QString() : Words::tr("%1 of %2 felt").arg(felt).arg(known);
}

QString sensation(const json& fields) {
  const auto felt = fields.find("monofilament_felt_of_10");
  return felt != fields.end() && felt->is_number()
             ? Words::tr("%1 of 10 points felt")
                   .arg(QLocale().toString(felt->get<double>(), 'g', 3))
             : QString();
}

QString hba1c(const json& fields) {
  const auto value = fields.find("hba1c_percent");
  return value != fields.end() && value->is_number()
             ? QLocale().toString(value->get<double>(), 'f', 1) + QStringLiteral(u"\u202F%")
             : QString();
}

QString probe(const json& fields) {
  const std::string found = textIn(fields, "probe_to_bone");
  return found.empty()         ? QString()
         : found == "positive" ? Words::tr("Positive")
                               : Words::tr("Negative");
}

QString offloading(const json& fields) {
  return QString::fromStdString(textIn(fields, "offloading"));
}

/// Each value as the newest visit has it that has it at all.
std::vector<LastKnown> lastKnown(const std::vector<Visit>& visits) {
  const std::pair<QString, QString (*)(const json&)> rows[] = {
      {Words::tr("HbA1c"), &hba1c},
      {Words::tr("Foot pulses"), &pulses},
      {Words::tr("Sensation"), &sensation},
      {Words::tr("Probe to bone"), &probe},
      {Words::tr("Offloading"), &offloading}};
  std::vector<LastKnown> known;
  for (const auto& [name, read] : rows) {
    for (auto visit = visits.rbegin(); visit != visits.rend(); ++visit) {
      if (const QString value = read(visit->content.fields); !value.isEmpty()) {
        known.push_back({name, value, dateAt(visit->content.taken_at_ms)});
        break;
      }
    }
  }
  return known;
}

}  // namespace

Expected<PatientSummary> patientSummary(Store& store, const std::string& id) {
  auto history = patientHistory(store, id);
  if (!history) {
    return tl::unexpected(history.error());
  }
  std::unordered_map<std::string, const Measurement*> measured;
  for (const Measurement& measurement : history->measurements) {
    measured[measurement.visit_id] = &measurement;  // the last one counts
  }
  std::unordered_map<std::string, FootSide> sides;
  for (const Foot& foot : history->feet) {
    sides[foot.id] = foot.fields.side;
  }
  PatientSummary summary{.patient = history->patient, .feet = history->feet};
  for (const Wound& wound : history->wounds) {
    WoundSummary line{.id = wound.id,
                      .side = sides[wound.foot_id],
                      .fields = wound.fields,
                      .number = wound.number};
    for (const Visit& visit : history->visits) {
      if (visit.wound_id == wound.id) {
        const auto found = measured.find(visit.id);
        line.visits.push_back(summaryOf(visit, found == measured.end() ? nullptr : found->second));
      }
    }
    summary.wounds.push_back(std::move(line));
  }
  std::ranges::stable_sort(summary.wounds, {}, [](const WoundSummary& wound) {
    return std::pair(wound.side == FootSide::Left, wound.number);
  });
  summary.known = lastKnown(history->visits);
  return summary;
}

std::optional<double> areaRatio(const VisitSummary& then, const VisitSummary& now) {
  if (!then.area_mm2 || !now.area_mm2 || *then.area_mm2 <= 0.0) {
    return std::nullopt;
  }
  return *now.area_mm2 / *then.area_mm2;
}

std::optional<double> edgeAdvance(const VisitSummary& then, const VisitSummary& now) {
  if (!then.area_mm2 || !now.area_mm2 || !then.perimeter_mm || !now.perimeter_mm) {
    return std::nullopt;
  }
  return gilmanAdvance({*then.area_mm2, *then.perimeter_mm},
                       {*now.area_mm2, *now.perimeter_mm},
                       static_cast<double>(then.date.daysTo(now.date)));
}

QString changeInWords(const VisitSummary& then, const VisitSummary& now) {
  if (!then.area_mm2 || !now.area_mm2) {
    return {};
  }
  const Change change =
      changeOf(*then.area_mm2, then.area_interval_mm2, *now.area_mm2, now.area_interval_mm2);
  if (!change.percent || !change.detectable) {
    return {};  // without both ranges nobody can say whether it changed
  }
  if (!*change.detectable) {
    return Words::tr("within error");
  }
  const QString percent =
      QLocale().toString(static_cast<int>(std::lround(std::abs(*change.percent))));
  return (*change.percent < 0.0 ? Words::tr("%1 % smaller") : Words::tr("%1 % larger"))
      .arg(percent);
}

QString fullName(const PatientFields& fields) {
  return QString::fromStdString(fields.given_name + " " + fields.family_name).trimmed();
}

QDate dateOf(const std::string& iso) {
  return QDate::fromString(QString::fromStdString(iso), Qt::ISODate);
}

QDate dateAt(std::int64_t at_ms) { return QDateTime::fromMSecsSinceEpoch(at_ms).date(); }

}  // namespace tarsus
