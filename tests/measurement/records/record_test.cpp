#include "tests/measurement/records/record_test.h"

#include "tests/measurement/records/postgres_server.h"

#include <fstream>
#include <utility>

namespace tarsus {

StoreEnvironment testEnvironment(ClockMs now_ms, std::string station) {
  return {.now_ms = std::move(now_ms),
          .station = std::move(station),
          .idle_ms = std::nullopt,
          .key_cost = {.operations = 1, .memory_bytes = 8192}};
}

WoundFields heelWound() {
  return {.place = "heel", .aspect = "plantar", .onset = "2025-11-02", .aetiology = "neuropathic"};
}

VisitContent sampleVisit(std::int64_t taken_at_ms, const std::string& notes) {
  return {.taken_at_ms = taken_at_ms,
          .fields = {{"abi", 0.9}, {"exudate_amount", "light"}, {"notes", notes}}};
}

std::string engineName(const testing::TestParamInfo<Database::Engine>& info) {
  return info.param == Database::Engine::Sqlite ? "Sqlite" : "Postgres";
}

void RecordTest::SetUp() {
  place_.folder = folder_.path() / ("store" + std::to_string(++stores_));
  if (GetParam() == Database::Engine::Postgres) {
    PostgresServer& server = PostgresServer::instance();
    if (!server.missing().empty()) {
      GTEST_SKIP() << server.missing();
    }
    place_.postgres = server.newDatabase();
  }
  setUpUsers();
}

Store RecordTest::openStore(const std::string& station) {
  return must(Store::open(place_, testEnvironment(clock(), station)));
}

Store RecordTest::openAs(const std::string& user, const std::string& station) {
  Store store = openStore(station);
  must(signIn(store, user, kPassword));
  return store;
}

void RecordTest::setUpUsers() {
  Store store = openStore("office");
  recovery_code_ = must(firstRun(store, "anna", kPassword));
  must(addUser(store, "petra", Role::Physician, kPassword));
  must(addUser(store, "nils", Role::Nurse, kPassword));
  must(addUser(store, "rita", Role::ReadOnly, kPassword));
}

RecordTest::Wounded RecordTest::addWounded(Store& store, const std::string& family) {
  Wounded wounded;
  wounded.patient = must(addPatient(store, named(family, "Maria")));
  wounded.foot = must(addFoot(store, wounded.patient.id, {.side = FootSide::Left}));
  wounded.wound = must(addWound(store, wounded.foot.id, heelWound()));
  return wounded;
}

std::filesystem::path RecordTest::writeSource(const std::string& name, const std::string& text) {
  const std::filesystem::path path = folder_.path() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

}  // namespace tarsus
