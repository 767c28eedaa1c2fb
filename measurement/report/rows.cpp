#include "measurement/report/rows.h"

#include "measurement/report/numbers.h"

#include <QCoreApplication>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(ReportRows)
};

constexpr double kCm2PerMm2 = 0.01;
constexpr double kMlPerMm3 = 0.001;

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

QString unitOf(Printed kind) {
  switch (kind) {
    case Printed::AreaCm2:
      return QStringLiteral(u"cm\u00B2");
    case Printed::VolumeMl:
      return QStringLiteral("mL");
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

QString reasonOf(const WoundMeasurement& m, const std::string& key, bool has_value) {
  const auto found = m.not_measurable.find(key);
  if (found != m.not_measurable.end()) {
    return QString::fromStdString(found->second);
  }
  return has_value ? QString() : Words::tr("no reason was recorded");
}

MeasurementRow rowOf(const WoundMeasurement& m, const Entry& entry) {
  MeasurementRow row;
  row.key = entry.key;
  row.name = entry.name;
  row.method = entry.method;
  row.unit = unitOf(entry.kind);
  const bool finite = entry.value && std::isfinite(*entry.value);
  row.reason = reasonOf(m, entry.key, finite);
  if (!row.reason.isEmpty()) {
    return row;
  }
  const int decimals = std::min(entry.most_decimals, decimalsOf(m, entry.key, entry.kind));
  const double factor = factorOf(entry.kind);
  const std::string printed = fixedText(*entry.value * factor, decimals);
  // A quantity that may be too small to tell from none never reads as a bare 0.
  if (entry.kind == Printed::VolumeMl && printed == fixedText(0.0, decimals)) {
    row.below_limit = true;
    row.value = QStringLiteral("< ") +
                QString::fromStdString(fixedText(std::pow(10.0, -decimals), decimals));
    return row;
  }
  row.value = QString::fromStdString(printed);
  if (entry.kind == Printed::Percent) {
    row.value += QStringLiteral(u"\u00A0%");
    row.unit = Words::tr("of the bed");
  }
  if (const Interval* interval = intervalOf(m, entry.key)) {
    row.interval = QString::fromStdString(intervalText(*interval, factor, decimals));
  }
  return row;
}

/// Length and width share a line and their decimals: those of the less certain of the two.
MeasurementRow pairRow(const WoundMeasurement& m, Entry length, Entry width) {
  length.most_decimals =
      std::min(decimalsOf(m, length.key, length.kind), decimalsOf(m, width.key, width.kind));
  width.most_decimals = length.most_decimals;
  MeasurementRow first = rowOf(m, length);
  const MeasurementRow second = rowOf(m, width);
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

void appendAreas(std::vector<MeasurementRow>& rows, const WoundMeasurement& m) {
  rows.push_back(rowOf(m,
                       {"opening_area_mm2",
                        Words::tr("Area, opening"),
                        Words::tr("reference skin inside the outline"),
                        Printed::AreaCm2,
                        m.opening_area_mm2}));
  rows.back().primary = true;
  rows.push_back(rowOf(m,
                       {"bed_area_mm2",
                        Words::tr("Area, bed"),
                        Words::tr("surface of the bed inside the outline"),
                        Printed::AreaCm2,
                        m.bed_area_mm2}));
  rows.push_back(rowOf(m,
                       {"projected_area_mm2",
                        Words::tr("Area, projected"),
                        Words::tr("best-fit plane, as a photograph gives"),
                        Printed::AreaCm2,
                        m.projected_area_mm2}));
  rows.push_back(rowOf(m,
                       {"perimeter_mm",
                        Words::tr("Perimeter"),
                        Words::tr("along the surface"),
                        Printed::LengthMm,
                        m.perimeter_mm}));
  rows.push_back(pairRow(m,
                         {"length_mm",
                          Words::tr("Length × width"),
                          Words::tr("greatest chord × greatest perpendicular chord"),
                          Printed::LengthMm,
                          m.length_mm},
                         {"width_mm", {}, {}, Printed::LengthMm, m.width_mm}));
  rows.push_back(pairRow(m,
                         {"length_clock_mm",
                          Words::tr("Length × width, clock"),
                          Words::tr("heel–toe axis × perpendicular"),
                          Printed::LengthMm,
                          m.length_clock_mm},
                         {"width_clock_mm", {}, {}, Printed::LengthMm, m.width_clock_mm}));
  rows.back().ends_group = true;
}

void appendVolumes(std::vector<MeasurementRow>& rows, const WoundMeasurement& m) {
  rows.push_back(rowOf(m,
                       {"volume_mm3",
                        Words::tr("Volume below skin"),
                        Words::tr("between bed and reference skin"),
                        Printed::VolumeMl,
                        m.volume_mm3}));
  rows.back().primary = true;
  rows.push_back(rowOf(m,
                       {"volume_above_mm3",
                        Words::tr("Volume above skin"),
                        Words::tr("reported apart, never subtracted"),
                        Printed::VolumeMl,
                        m.volume_above_mm3}));
  rows.back().ends_group = true;
}

void appendDepths(std::vector<MeasurementRow>& rows, const WoundMeasurement& m) {
  rows.push_back(rowOf(m,
                       {"max_depth_mm",
                        Words::tr("Depth, greatest"),
                        Words::tr("along the normal of the reference skin"),
                        Printed::DepthMm,
                        m.max_depth_mm}));
  rows.back().primary = true;
  rows.push_back(rowOf(m,
                       {"p99_depth_mm",
                        Words::tr("Depth, 99th percentile"),
                        Words::tr("robust to single points"),
                        Printed::DepthMm,
                        m.p99_depth_mm}));
  rows.push_back(rowOf(m,
                       {"mean_depth_mm",
                        Words::tr("Depth, mean"),
                        Words::tr("volume below skin ÷ area, opening"),
                        Printed::DepthMm,
                        m.mean_depth_mm}));
  rows.back().ends_group = true;
}

}  // namespace

std::vector<MeasurementRow> measurementRows(const WoundMeasurement& measurement) {
  std::vector<MeasurementRow> rows;
  appendAreas(rows, measurement);
  appendVolumes(rows, measurement);
  appendDepths(rows, measurement);
  rows.push_back(rowOf(measurement,
                       {"unseen_bed_fraction",
                        Words::tr("Bed not seen"),
                        Words::tr("share of the bed that was filled; limit 10 %"),
                        Printed::Percent,
                        measurement.unseen_bed_fraction}));
  return rows;
}

}  // namespace tarsus
