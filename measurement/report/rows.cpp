#include "measurement/report/rows.h"

#include "measurement/report/numbers.h"
#include "measurement/report/phrases.h"
#include "measurement/report/visit_content.h"
#include "reconstruction/base/require.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kCm2PerMm2 = 0.01;
constexpr double kMlPerMm3 = 0.001;

using Quantity = std::pair<const char*, std::optional<double> WoundMeasurement::*>;
constexpr std::array kQuantities{
    Quantity{"opening_area_mm2", &WoundMeasurement::opening_area_mm2},
    Quantity{"bed_area_mm2", &WoundMeasurement::bed_area_mm2},
    Quantity{"projected_area_mm2", &WoundMeasurement::projected_area_mm2},
    Quantity{"perimeter_mm", &WoundMeasurement::perimeter_mm},
    Quantity{"volume_mm3", &WoundMeasurement::volume_mm3},
    Quantity{"volume_above_mm3", &WoundMeasurement::volume_above_mm3},
    Quantity{"mean_depth_mm", &WoundMeasurement::mean_depth_mm},
    Quantity{"max_depth_mm", &WoundMeasurement::max_depth_mm},
    Quantity{"p99_depth_mm", &WoundMeasurement::p99_depth_mm},
    Quantity{"length_mm", &WoundMeasurement::length_mm},
    Quantity{"width_mm", &WoundMeasurement::width_mm},
    Quantity{"length_clock_mm", &WoundMeasurement::length_clock_mm},
    Quantity{"width_clock_mm", &WoundMeasurement::width_clock_mm},
    Quantity{"unseen_bed_fraction", &WoundMeasurement::unseen_bed_fraction}};

/// How one quantity is printed, before its number is known.
struct Entry {
  std::string key;
  QString name;
  QString method;
  Printed kind = Printed::LengthMm;
  std::optional<double> value;
  int most_decimals = 9;
};

double factorOf(Printed kind) {
  switch (kind) {
    case Printed::AreaCm2:
      return kCm2PerMm2;
    case Printed::VolumeMl:
      return kMlPerMm3;
    case Printed::Percent:
      return 100.0;
    case Printed::LengthMm:
    case Printed::DepthMm:
      return 1.0;
  }
  return 1.0;
}

QString unitOf(Printed kind, const Speech& say) {
  switch (kind) {
    case Printed::AreaCm2:
      return QStringLiteral(u"cm\u00B2");
    case Printed::VolumeMl:
      return say.millilitres();
    case Printed::Percent:
      return {};  // stands with the value
    case Printed::LengthMm:
    case Printed::DepthMm:
      return QStringLiteral("mm");
  }
  return {};
}

const Interval* intervalOf(const WoundMeasurement& m, const std::string& key) {
  const auto found = m.intervals.find(key);
  return found == m.intervals.end() ? nullptr : &found->second;
}

/// All depths take the decimals of the greatest depth, everything else its own.
int decimalsOf(const WoundMeasurement& m, const std::string& key, Printed kind) {
  const Interval* interval = intervalOf(m, kind == Printed::DepthMm ? "max_depth_mm" : key);
  if (interval == nullptr) {
    return printedDecimals(kind, std::nullopt);
  }
  return printedDecimals(kind, 0.5 * (interval->high - interval->low) * factorOf(kind));
}

QString reasonOf(const WoundMeasurement& m,
                 const std::string& key,
                 bool has_value,
                 const Speech& say) {
  const auto found = m.not_measurable.find(key);
  if (found != m.not_measurable.end()) {
    return say.sentence(found->second);
  }
  return has_value ? QString() : say(phrase::kNoReason);
}

MeasurementRow rowOf(const WoundMeasurement& m, const Entry& entry, const Speech& say) {
  MeasurementRow row;
  row.key = entry.key;
  row.keys = {entry.key};
  row.kind = entry.kind;
  row.factor = factorOf(entry.kind);
  row.decimals = std::min(entry.most_decimals, decimalsOf(m, entry.key, entry.kind));
  row.name = entry.name;
  row.method = entry.method;
  row.unit = unitOf(entry.kind, say);
  const bool finite = entry.value && std::isfinite(*entry.value);
  row.reason = reasonOf(m, entry.key, finite, say);
  if (!row.reason.isEmpty()) {
    return row;
  }
  const QString printed = say.number(*entry.value * row.factor, row.decimals);
  // A quantity that may be too small to tell from none never reads as a bare 0.
  if (entry.kind == Printed::VolumeMl && printed == say.number(0.0, row.decimals)) {
    row.below_limit = true;
    row.value = QStringLiteral("< ") + say.number(std::pow(10.0, -row.decimals), row.decimals);
    return row;
  }
  row.value = printed;
  if (entry.kind == Printed::Percent) {
    row.value = say.percent(printed);
    row.unit = say(phrase::kOfTheBed);
  }
  if (const Interval* interval = intervalOf(m, entry.key)) {
    row.interval = say.interval(*interval, row.factor, row.decimals);
  }
  return row;
}

/// Length and width share a line and their decimals: those of the less certain of the two.
MeasurementRow pairRow(const WoundMeasurement& m, Entry length, Entry width, const Speech& say) {
  length.most_decimals =
      std::min(decimalsOf(m, length.key, length.kind), decimalsOf(m, width.key, width.kind));
  width.most_decimals = length.most_decimals;
  MeasurementRow first = rowOf(m, length, say);
  first.keys.push_back(width.key);
  const MeasurementRow second = rowOf(m, width, say);
  if (!first.reason.isEmpty() || !second.reason.isEmpty()) {
    first.value.clear();
    first.interval.clear();
    first.reason = first.reason.isEmpty() ? second.reason : first.reason;
    return first;
  }
  const QString times = QStringLiteral(u"\u00A0\u00D7\u00A0");
  first.value += times + second.value;
  if (!first.interval.isEmpty() && !second.interval.isEmpty()) {
    first.interval += times + second.interval;
  } else {
    first.interval.clear();
  }
  return first;
}

void appendAreas(std::vector<MeasurementRow>& rows, const WoundMeasurement& m, const Speech& say) {
  rows.push_back(rowOf(m,
                       {"opening_area_mm2",
                        say(phrase::kArea),
                        say(phrase::kAreaHow),
                        Printed::AreaCm2,
                        m.opening_area_mm2},
                       say));
  rows.back().primary = true;
  rows.push_back(rowOf(m,
                       {"bed_area_mm2",
                        say(phrase::kBedArea),
                        say(phrase::kBedAreaHow),
                        Printed::AreaCm2,
                        m.bed_area_mm2},
                       say));
  rows.push_back(rowOf(m,
                       {"projected_area_mm2",
                        say(phrase::kProjected),
                        say(phrase::kProjectedHow),
                        Printed::AreaCm2,
                        m.projected_area_mm2},
                       say));
  rows.push_back(rowOf(m,
                       {"perimeter_mm",
                        say(phrase::kPerimeter),
                        say(phrase::kPerimeterHow),
                        Printed::LengthMm,
                        m.perimeter_mm},
                       say));
  rows.push_back(pairRow(m,
                         {"length_mm",
                          say(phrase::kLengthWidth),
                          say(phrase::kLengthWidthHow),
                          Printed::LengthMm,
                          m.length_mm},
                         {"width_mm", {}, {}, Printed::LengthMm, m.width_mm},
                         say));
  rows.push_back(pairRow(m,
                         {"length_clock_mm",
                          say(phrase::kClockLength),
                          say(phrase::kClockLengthHow),
                          Printed::LengthMm,
                          m.length_clock_mm},
                         {"width_clock_mm", {}, {}, Printed::LengthMm, m.width_clock_mm},
                         say));
  rows.back().ends_group = true;
}

void appendVolumes(std::vector<MeasurementRow>& rows,
                   const WoundMeasurement& m,
                   const Speech& say) {
  rows.push_back(rowOf(m,
                       {"volume_mm3",
                        say(phrase::kVolume),
                        say(phrase::kVolumeHow),
                        Printed::VolumeMl,
                        m.volume_mm3},
                       say));
  rows.back().primary = true;
  rows.push_back(rowOf(m,
                       {"volume_above_mm3",
                        say(phrase::kVolumeAbove),
                        say(phrase::kVolumeAboveHow),
                        Printed::VolumeMl,
                        m.volume_above_mm3},
                       say));
  rows.back().ends_group = true;
}

void appendDepths(std::vector<MeasurementRow>& rows, const WoundMeasurement& m, const Speech& say) {
  rows.push_back(rowOf(m,
                       {"max_depth_mm",
                        say(phrase::kDepth),
                        say(phrase::kDepthHow),
                        Printed::DepthMm,
                        m.max_depth_mm},
                       say));
  rows.back().primary = true;
  rows.push_back(rowOf(m,
                       {"p99_depth_mm",
                        say(phrase::kDepth99),
                        say(phrase::kDepth99How),
                        Printed::DepthMm,
                        m.p99_depth_mm},
                       say));
  rows.push_back(rowOf(m,
                       {"mean_depth_mm",
                        say(phrase::kDepthMean),
                        say(phrase::kDepthMeanHow),
                        Printed::DepthMm,
                        m.mean_depth_mm},
                       say));
  rows.back().ends_group = true;
}

}  // namespace

std::vector<MeasurementRow> measurementRows(const WoundMeasurement& measurement,
                                            const Speech& say) {
  std::vector<MeasurementRow> rows;
  appendAreas(rows, measurement, say);
  appendVolumes(rows, measurement, say);
  appendDepths(rows, measurement, say);
  rows.push_back(rowOf(measurement,
                       {"unseen_bed_fraction",
                        say(phrase::kBedUnseen),
                        say(phrase::kBedUnseenHow),
                        Printed::Percent,
                        measurement.unseen_bed_fraction},
                       say));
  return rows;
}

WoundMeasurement nothingMeasured(const std::string& reason) {
  WoundMeasurement measurement;
  for (const auto& [name, value] : kQuantities) {
    measurement.not_measurable[name] = reason;
  }
  return measurement;
}

std::optional<double> measuredValue(const WoundMeasurement& m, const std::string& key) {
  const auto* found =
      std::ranges::find_if(kQuantities, [&](const auto& entry) { return key == entry.first; });
  TARSUS_REQUIRE(found != kQuantities.end(), "the table knows its quantities");
  const std::optional<double>& value = m.*(found->second);
  return value && std::isfinite(*value) && !m.not_measurable.contains(key) ? value : std::nullopt;
}

std::optional<Interval> measuredInterval(const WoundMeasurement& m, const std::string& key) {
  const Interval* interval = intervalOf(m, key);
  return interval == nullptr ? std::nullopt : std::optional(*interval);
}

const MeasurementRow& rowNamed(const std::vector<MeasurementRow>& rows, const std::string& key) {
  const auto found =
      std::ranges::find_if(rows, [&](const MeasurementRow& row) { return row.key == key; });
  TARSUS_REQUIRE(found != rows.end(), "the pages show quantities of the table");
  return *found;
}

}  // namespace tarsus
