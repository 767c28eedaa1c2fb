#pragma once

#include "measurement/records/history.h"
#include "measurement/report/report.h"

#include <functional>
#include <span>
#include <string>

namespace tarsus {

/// A user's name by the id that records keep.
using NameOfUser = std::function<std::string(const std::string& id)>;

/// What a visit's form says, for the printed page: findings, scores, notes, plan; the latter with
/// who last changed them.
/// @param versions  of the visit, oldest first; at least one
/// @errors ScoreInputInvalid
[[nodiscard]] Expected<void> addFindings(std::span<const Visit> versions,
                                         const NameOfUser& name_of,
                                         ReportContent& content);

/// How the ids in a history are printed.
struct HistoryNames {
  NameOfUser user;
  std::function<std::string(const std::string& id)> wound;  ///< "2 heel"
};

/// Who signed, countersigned and asked for changes, and what was amended: one entry for each
/// amendment, with the numbers before and after where the wound was measured again.
/// @param versions      of the visit, oldest first
/// @param measurements  of the visit, oldest first
void addHistory(std::span<const Visit> versions,
                std::span<const Measurement> measurements,
                const HistoryNames& names,
                ReportContent& content);

/// Changes of offloading and debridements, from the forms of all visits in the order of time.
void addEvents(std::span<const Visit> visits, ReportContent& content);

}  // namespace tarsus
