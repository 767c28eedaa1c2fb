#pragma once

#include "measurement/report/report.h"
#include "measurement/report/rows.h"

namespace tarsus {

/// The cells of one row that look back: previous visit, change, SDC, first visit.
struct ChangeCells {
  QString previous;
  QString change;  ///< with its sign; a dash where there is nothing to compare
  QString sdc;
  QString baseline;
  QString percent;          ///< of baseline
  bool detectable = false;  ///< |change| > SDC
  bool rises = false;
  bool compared = false;
};

/// The visit before this one and the first one; null where there is none.
[[nodiscard]] const ReportVisit* previousVisit(const ReportContent& content);
[[nodiscard]] const ReportVisit* firstVisit(const ReportContent& content);

/// The day of a visit, and that it is a draft where nobody has signed it.
[[nodiscard]] QString visitDate(const ReportVisit& visit, const Speech& say);

/// Whole days from one ISO 8601 day to another; empty where one of them is none.
[[nodiscard]] std::optional<int> daysBetween(const std::string& from, const std::string& to);

/// Change of one number; empty where it is not measurable at one of the visits.
[[nodiscard]] std::optional<Change> changeFrom(const WoundMeasurement& earlier,
                                               const WoundMeasurement& later,
                                               const std::string& key);

/// 95 % of the area reduction in percent, from the relative half-widths of both areas in
/// quadrature; empty where one area has no interval.
[[nodiscard]] std::optional<Interval> reductionInterval(const WoundMeasurement& first,
                                                        const WoundMeasurement& now);

/// Printed with the decimals of today's value, so that the columns can be compared by eye.
[[nodiscard]] ChangeCells changeCells(const ReportContent& content,
                                      const MeasurementRow& row,
                                      const Speech& say);

}  // namespace tarsus
