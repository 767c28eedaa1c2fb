#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tarsus {

struct Person {
  std::string name;
  Role role = Role::ReadOnly;
};

/// What the sign-in page shows before anything is unlocked. The names stand in clear in the
/// records; roles and the clinic's name are remembered beside them (station.json).
struct Station {
  std::string clinic;
  std::vector<Person> people;  ///< administrators last
};

/// @errors those of Database
[[nodiscard]] Expected<Station> readStation(Store& store, const std::filesystem::path& folder);
/// Keeps what is known now; needs somebody signed in.
[[nodiscard]] Expected<Station> rememberStation(Store& store, const std::filesystem::path& folder);

/// Wrong passwords in a row of one name.
[[nodiscard]] int failedAttempts(Store& store, const std::string& name);

}  // namespace tarsus
