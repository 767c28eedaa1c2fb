#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <string>

namespace tarsus {

/// An invented patient with five visits of a healing wound, of which the last is still a draft.
/// The numbers are those of the demonstration history: the last visit has the true values of the
/// synthetic forefoot, the earlier ones are scaled from it; there are no models behind them.
/// @return the patient's id
/// @errors NotPermitted, those of the records
[[nodiscard]] Expected<std::string> addDemoPatient(Store& store);

}  // namespace tarsus
