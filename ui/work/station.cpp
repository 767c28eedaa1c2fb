#include "ui/work/station.h"

#include "measurement/records/users.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace tarsus {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::string_view kUserHolder = "user:";

fs::path fileIn(const fs::path& folder) { return folder / "station.json"; }

json readFile(const fs::path& folder) {
  std::ifstream stream(fileIn(folder));
  const json kept = stream ? json::parse(stream, nullptr, false) : json();
  return kept.is_object() ? kept : json::object();
}

std::string textOf(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Role rememberedRole(const json& kept, const std::string& name) {
  const auto people = kept.find("people");
  if (people != kept.end() && people->is_array()) {
    for (const json& person : *people) {
      if (person.is_object() && textOf(person, "name") == name) {
        return roleNamed(textOf(person, "role")).value_or(Role::ReadOnly);
      }
    }
  }
  return Role::ReadOnly;
}

void sortPeople(std::vector<Person>& people) {
  std::ranges::sort(people, {}, [](const Person& person) {
    return std::pair(person.role == Role::Administrator, person.name);
  });
}

}  // namespace

Expected<Station> readStation(Store& store, const fs::path& folder) {
  const auto rows = store.database().query("SELECT holder FROM key_wrap");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  const json kept = readFile(folder);
  Station station{.clinic = textOf(kept, "clinic"), .people = {}};
  for (const SqlRow& row : *rows) {
    const std::string holder = row.text(0);
    if (holder.starts_with(kUserHolder)) {
      const std::string name = holder.substr(kUserHolder.size());
      station.people.push_back({.name = name, .role = rememberedRole(kept, name)});
    }
  }
  sortPeople(station.people);
  return station;
}

Expected<Station> rememberStation(Store& store, const fs::path& folder) {
  const auto users = listUsers(store);
  const auto settings = storeSettings(store);
  if (!users || !settings) {
    return tl::unexpected(!users ? users.error() : settings.error());
  }
  Station station{.clinic = textOf(settings->values, "clinic"), .people = {}};
  json people = json::array();
  for (const User& user : *users) {
    if (user.active) {
      station.people.push_back({.name = user.name, .role = user.role});
      people.push_back({{"name", user.name}, {"role", nameOf(user.role)}});
    }
  }
  sortPeople(station.people);
  const json kept = {{"clinic", station.clinic}, {"people", people}};
  auto written = writeTextAtomically(fileIn(folder), kept.dump(2));
  return written ? Expected<Station>(std::move(station)) : tl::unexpected(written.error());
}

int failedAttempts(Store& store, const std::string& name) {
  const auto rows = store.database().query("SELECT failures FROM key_wrap WHERE holder = ?",
                                           {std::string(kUserHolder) + name});
  return rows && !rows->empty() ? static_cast<int>(rows->front().integer(0)) : 0;
}

}  // namespace tarsus
