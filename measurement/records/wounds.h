#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

// The words of the fields, as they are kept.
inline constexpr std::array<std::string_view, 12> kWoundPlaces{"toe_1",
                                                               "toe_2",
                                                               "toe_3",
                                                               "toe_4",
                                                               "toe_5",
                                                               "mth_1",
                                                               "mth_2",
                                                               "mth_3",
                                                               "mth_4",
                                                               "mth_5",
                                                               "midfoot",
                                                               "heel"};
inline constexpr std::array<std::string_view, 5> kWoundAspects{
    "plantar", "dorsal", "medial", "lateral", "interdigital"};
inline constexpr std::array<std::string_view, 7> kAetiologies{"neuropathic",
                                                              "ischaemic",
                                                              "neuroischaemic",
                                                              "traumatic",
                                                              "pressure",
                                                              "postoperative",
                                                              "unknown"};

/// Where a wound came from; that it has healed is said by `healed_on`.
enum class WoundOrigin : std::uint8_t {
  New,
  Split,    ///< one of several that one wound became
  Merged,   ///< several became this one
  Recurred  ///< at the place of one that had healed
};
[[nodiscard]] std::string_view nameOf(WoundOrigin origin);

struct WoundFields {
  std::string place;      ///< one of kWoundPlaces
  std::string aspect;     ///< one of kWoundAspects
  std::string onset;      ///< date, or empty where it is not known
  std::string aetiology;  ///< one of kAetiologies
  WoundOrigin origin = WoundOrigin::New;
  std::vector<std::string> parents;  ///< ids: none (New), one (Split, Recurred), several (Merged)
  std::string healed_on;             ///< date, or empty while it is open
};

struct Wound {
  std::string id;
  std::string foot_id;
  std::int64_t revision = 0;
  int number = 0;  ///< on its foot, from 1, never used twice
  WoundFields fields;
  bool trashed = false;
};

/// @errors RecordInvalid (a word or date that is none, parents that do not suit the origin),
/// RecordMissing, NotPermitted
[[nodiscard]] Expected<Wound> addWound(Store& store,
                                       std::string_view foot_id,
                                       const WoundFields& fields);
/// @errors RecordStale, RecordInvalid, NotPermitted
[[nodiscard]] Expected<Wound> editWound(Store& store,
                                        std::string_view id,
                                        std::int64_t base_revision,
                                        const WoundFields& fields);
/// Filed under the wrong foot or patient: the wound with all its visits goes to another foot and
/// takes the next number there.
/// @errors RecordStale, RecordInvalid (no reason), RecordMissing, NotPermitted
[[nodiscard]] Expected<Wound> moveWound(Store& store,
                                        std::string_view id,
                                        std::int64_t base_revision,
                                        std::string_view foot_id,
                                        std::string_view reason);
[[nodiscard]] Expected<Wound> findWound(Store& store, std::string_view id);

}  // namespace tarsus
