#pragma once

#include "measurement/report/numbers.h"
#include "measurement/report/speech.h"
#include "measurement/wound/measure.h"

#include <QString>

#include <vector>

namespace tarsus {

/// One line of the table of measurements, in words and printed numbers.
struct MeasurementRow {
  std::string key;  ///< name in measurement.json
  QString name;
  QString method;    ///< how it was measured, one short line
  QString value;     ///< "2.24", "22.9 x 14.4"; empty where not measurable
  QString interval;  ///< 95 %; empty where there is none
  QString unit;
  QString reason;  ///< why it is not measurable; empty where it is
  bool primary = false;
  bool below_limit = false;  ///< smaller than the last printed digit: "< 0.01", in grey
  bool ends_group = false;
  std::vector<std::string> keys;  ///< one name, or those of length and width
  Printed kind = Printed::LengthMm;
  int decimals = 0;
  double factor = 1.0;  ///< printed = stored * factor
};

/// Every quantity of the report, in its fixed order. A value that `not_measurable` names is shown
/// as its reason, also where a (filled) number exists.
[[nodiscard]] std::vector<MeasurementRow> measurementRows(const WoundMeasurement& measurement,
                                                          const Speech& say);

/// The stored value by its name in measurement.json; empty where it is not measurable.
[[nodiscard]] std::optional<double> measuredValue(const WoundMeasurement& measurement,
                                                  const std::string& key);

[[nodiscard]] std::optional<Interval> measuredInterval(const WoundMeasurement& measurement,
                                                       const std::string& key);

/// The row of a quantity that is always there.
[[nodiscard]] const MeasurementRow& rowNamed(const std::vector<MeasurementRow>& rows,
                                             const std::string& key);

}  // namespace tarsus
