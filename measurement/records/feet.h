#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

enum class FootSide : std::uint8_t { Left, Right };
[[nodiscard]] std::string_view nameOf(FootSide side);

struct FootFields {
  FootSide side = FootSide::Left;
  std::vector<int> missing_toes;  ///< 1 (great toe) to 5; landmarks then take the most distal point
  bool forefoot_missing = false;
};

struct Foot {
  std::string id;
  std::string patient_id;
  std::int64_t revision = 0;
  FootFields fields;
  bool trashed = false;
};

/// @errors RecordInvalid (a toe that no foot has, a side that the patient has already),
/// RecordMissing, NotPermitted
[[nodiscard]] Expected<Foot> addFoot(Store& store,
                                     std::string_view patient_id,
                                     const FootFields& fields);
/// @errors RecordStale, RecordInvalid, NotPermitted
[[nodiscard]] Expected<Foot> editFoot(Store& store,
                                      std::string_view id,
                                      std::int64_t base_revision,
                                      const FootFields& fields);
[[nodiscard]] Expected<Foot> findFoot(Store& store, std::string_view id);

}  // namespace tarsus
