#pragma once

#include "measurement/records/history.h"
#include "measurement/report/report.h"

#include <functional>
#include <span>
#include <string>

namespace tarsus {

/// A user's name by the id that records keep.
using NameOfUser = std::function<std::string(const std::string& id)>;

/// What a visit's form says, for the printed page: findings, scores, notes, plan.
/// @errors ScoreInputInvalid
[[nodiscard]] Expected<void> addFindings(const Visit& visit,
                                         const NameOfUser& name_of,
                                         ReportContent& content);

/// Who signed, countersigned and asked for changes, and what was amended.
/// @param versions  of the visit, oldest first
void addHistory(std::span<const Visit> versions, const NameOfUser& name_of, ReportContent& content);

/// Changes of offloading and debridements, from the forms of all visits in the order of time.
void addEvents(std::span<const Visit> visits, ReportContent& content);

}  // namespace tarsus
