#pragma once

#include "measurement/records/roles.h"
#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

struct User {
  std::string id;
  std::int64_t revision = 0;
  std::string name;  ///< to sign in with; stands in clear, as it is asked for before the unlock
  Role role = Role::ReadOnly;
  bool active = true;
};

/// @errors NotPermitted, RecordInvalid (no name, a name that is taken, a password under 8 letters)
[[nodiscard]] Expected<User> addUser(Store& store,
                                     std::string_view name,
                                     Role role,
                                     std::string_view password);
/// Another role, or no more access: then the password opens nothing any more. Who has seen the
/// store key before may have kept it; the key itself is not changed.
/// @errors NotPermitted, RecordStale, StepNotAllowed (the last administrator; access again for one
/// who has no password any more: givePassword)
[[nodiscard]] Expected<User> changeUser(
    Store& store, std::string_view id, std::int64_t base_revision, Role role, bool active);
/// A new password from an administrator, for one who forgot it; gives access again where it was
/// taken away.
/// @errors NotPermitted, RecordMissing, RecordInvalid (under 8 letters)
[[nodiscard]] Expected<User> givePassword(Store& store,
                                          std::string_view id,
                                          std::string_view password);
[[nodiscard]] Expected<std::vector<User>> listUsers(Store& store);
/// @errors RecordMissing
[[nodiscard]] Expected<User> findUser(Store& store, std::string_view id);

/// The store's settings: one JSON object, kept with its revisions like any record.
struct StoreSettings {
  std::int64_t revision = 0;  ///< 0: never set
  nlohmann::json values = nlohmann::json::object();
};
[[nodiscard]] Expected<StoreSettings> storeSettings(Store& store);
/// @errors NotPermitted, RecordStale, RecordInvalid
[[nodiscard]] Expected<StoreSettings> changeStoreSettings(Store& store,
                                                          const StoreSettings& settings);

}  // namespace tarsus
