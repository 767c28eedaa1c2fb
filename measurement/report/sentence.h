#pragma once

#include "measurement/report/changes.h"

namespace tarsus {

/// What changed and what was measured, from a closed set of sentences: no adjective, no advice.
[[nodiscard]] QString sentenceInWords(const ReportContent& content,
                                      const std::vector<MeasurementRow>& rows,
                                      const Speech& say);

}  // namespace tarsus
