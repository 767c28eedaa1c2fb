#pragma once

#include "measurement/report/report.h"

#include <nlohmann/json_fwd.hpp>

namespace tarsus {

/// What reconstruction.json says of the scan behind a model: quality rows and refusal reasons.
/// Nothing where it was said of another model.
void addScanQuality(const nlohmann::json& reconstruction, ReportContent& content);

}  // namespace tarsus
