#include "measurement/report/changes.h"

#include "measurement/report/phrases.h"

#include <QDate>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

const QString& dash() {
  static const QString en_dash(1, QChar(0x2013));
  return en_dash;
}

const QString& times() {
  static const QString sign = QStringLiteral(u"\u00A0\u00D7\u00A0");
  return sign;
}

/// One printed number per name of the row, or a dash where one of them is missing.
QString valuesOf(const WoundMeasurement& m, const MeasurementRow& row, const Speech& say) {
  QStringList parts;
  for (const std::string& key : row.keys) {
    const std::optional<double> value = measuredValue(m, key);
    if (!value) {
      return m.not_measurable.contains(key) ? say(phrase::kNm) : dash();
    }
    const QString number = say.number(*value * row.factor, row.decimals);
    if (row.kind == Printed::VolumeMl && number == say.number(0.0, row.decimals)) {
      return QStringLiteral("< ") + say.number(std::pow(10.0, -row.decimals), row.decimals);
    }
    parts << number;
  }
  const QString text = parts.join(times());
  return row.kind == Printed::Percent ? say.percent(text) : text;
}

QString percentOf(const WoundMeasurement& baseline,
                  const WoundMeasurement& today,
                  const MeasurementRow& row,
                  const Speech& say) {
  QStringList parts;
  for (const std::string& key : row.keys) {
    const std::optional<double> first = measuredValue(baseline, key);
    const std::optional<double> now = measuredValue(today, key);
    if (!first || !now || !(*first > 0.0)) {
      return dash();
    }
    parts << say.number(100.0 * *now / *first, 0);
  }
  return say.percent(parts.join(times()));
}

void fillChange(ChangeCells& cells,
                const WoundMeasurement& earlier,
                const WoundMeasurement& today,
                const MeasurementRow& row,
                const Speech& say) {
  QStringList parts;
  double greatest_sdc = 0.0;
  bool has_sdc = true;
  for (std::size_t i = 0; i < row.keys.size(); ++i) {
    const std::optional<Change> change = changeFrom(earlier, today, row.keys[i]);
    if (!change) {
      return;
    }
    parts << say.signedNumber(change->value * row.factor, row.decimals);
    has_sdc = has_sdc && change->sdc.has_value();
    greatest_sdc = std::max(greatest_sdc, change->sdc.value_or(0.0));
    cells.detectable = cells.detectable || change->detectable.value_or(false);
    cells.rises = i == 0 ? change->value > 0.0 : cells.rises;
  }
  cells.compared = has_sdc;
  if (has_sdc) {
    cells.change = parts.join(times());
    cells.sdc = say.number(greatest_sdc * row.factor, row.decimals);
  }
}

}  // namespace

const ReportVisit* previousVisit(const ReportContent& content) {
  return content.visits.size() < 2 ? nullptr : &content.visits[content.visits.size() - 2];
}

const ReportVisit* firstVisit(const ReportContent& content) {
  return content.visits.size() < 2 ? nullptr : &content.visits.front();
}

QString visitDate(const ReportVisit& visit, const Speech& say) {
  const QString date = say.date(visit.date);
  return visit.draft ? date + QLatin1Char(' ') + say(phrase::kDraftVisit) : date;
}

std::optional<int> daysBetween(const std::string& from, const std::string& to) {
  const QDate first = QDate::fromString(QString::fromStdString(from).left(10), Qt::ISODate);
  const QDate last = QDate::fromString(QString::fromStdString(to).left(10), Qt::ISODate);
  if (!first.isValid() || !last.isValid()) {
    return std::nullopt;
  }
  return static_cast<int>(first.daysTo(last));
}

std::optional<Change> changeFrom(const WoundMeasurement& earlier,
                                 const WoundMeasurement& later,
                                 const std::string& key) {
  const std::optional<double> before = measuredValue(earlier, key);
  const std::optional<double> now = measuredValue(later, key);
  if (!before || !now) {
    return std::nullopt;
  }
  return changeOf(*before, measuredInterval(earlier, key), *now, measuredInterval(later, key));
}

std::optional<Interval> reductionInterval(const WoundMeasurement& first,
                                          const WoundMeasurement& now) {
  const std::string key = "opening_area_mm2";
  const auto before = measuredValue(first, key);
  const auto after = measuredValue(now, key);
  const auto before_interval = measuredInterval(first, key);
  const auto after_interval = measuredInterval(now, key);
  if (!before || !after || !before_interval || !after_interval || !(*before > 0.0)) {
    return std::nullopt;
  }
  const auto half = [](const Interval& interval) { return 0.5 * (interval.high - interval.low); };
  const double ratio = *after / *before;
  const double spread =
      100.0 * std::hypot(half(*after_interval) / *before, ratio * half(*before_interval) / *before);
  const double reduction = 100.0 * (1.0 - ratio);
  return Interval{reduction - spread, reduction + spread};
}

ChangeCells changeCells(const ReportContent& content,
                        const MeasurementRow& row,
                        const Speech& say) {
  ChangeCells cells{dash(), dash(), {}, dash(), dash()};
  const ReportVisit* previous = previousVisit(content);
  const ReportVisit* first = firstVisit(content);
  if (previous == nullptr || first == nullptr) {
    return cells;
  }
  cells.previous = valuesOf(previous->measurement, row, say);
  cells.baseline = valuesOf(first->measurement, row, say);
  if (row.kind != Printed::Percent && !row.below_limit) {
    fillChange(cells, previous->measurement, content.measurement, row, say);
    cells.percent = percentOf(first->measurement, content.measurement, row, say);
  }
  return cells;
}

}  // namespace tarsus
