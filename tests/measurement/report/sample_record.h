#pragma once

#include "tests/measurement/report/sample_wound.h"

namespace tarsus::sample {

/// The sample wound with a whole record around it: identity, earlier visits, findings, scores,
/// notes, signatures. Invented data.
/// @param visits  1 or more; at the second of more than two, volume and depth are not measurable
[[nodiscard]] ReportContent makeRecord(int visits);

/// Another language, same facts.
[[nodiscard]] ReportContent in(ReportLanguage language, ReportContent content);

/// Every text that a person typed made long, every number unmeasurable.
[[nodiscard]] ReportContent withLongTexts(ReportContent content);
[[nodiscard]] ReportContent withNothingMeasured(ReportContent content);

/// With that many other wounds of the same visit, the first two with pictures.
[[nodiscard]] ReportContent withOtherWounds(ReportContent content, int count);

}  // namespace tarsus::sample
