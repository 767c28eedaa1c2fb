#pragma once

#include "measurement/records/feet.h"
#include "measurement/records/history.h"
#include "measurement/records/patients.h"
#include "measurement/records/sign_in.h"
#include "measurement/records/store.h"
#include "measurement/records/users.h"
#include "measurement/records/visits.h"
#include "measurement/records/wounds.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace tarsus {

inline constexpr const char* kPassword = "a long password";

/// Fails the test with the error's text where there is none.
template <typename T>
T must(Expected<T> result) {
  if (!result) {
    ADD_FAILURE() << describe(result.error());
    throw std::runtime_error(describe(result.error()));
  }
  if constexpr (!std::is_void_v<T>) {
    return std::move(*result);
  }
}

template <typename T>
void expectFails(const Expected<T>& result, ErrorCode code) {
  ASSERT_FALSE(result);
  EXPECT_EQ(codeName(result.error().code), codeName(code)) << describe(result.error());
}

/// Cheap passwords, no idling unless asked for.
[[nodiscard]] StoreEnvironment testEnvironment(ClockMs now_ms, std::string station);
[[nodiscard]] WoundFields heelWound();
[[nodiscard]] VisitContent sampleVisit(std::int64_t taken_at_ms, const std::string& notes);
[[nodiscard]] inline PatientFields named(const std::string& family, const std::string& given) {
  return {.family_name = family, .given_name = given, .birth_date = "1950-12-31"};
}

/// A store of either kind with an administrator (anna), a physician (petra), a nurse (nils) and a
/// reader (rita); time stands still unless a test moves it.
class RecordTest : public testing::TestWithParam<Database::Engine> {
 protected:
  /// A fresh store; called again, another one.
  void SetUp() override;
  /// Another connection, as from another station; not signed in.
  [[nodiscard]] Store openStore(const std::string& station = "ward 1");
  [[nodiscard]] Store openAs(const std::string& user, const std::string& station = "ward 1");
  [[nodiscard]] ClockMs clock() {
    return [now = now_ms_] { return *now; };
  }
  void setUpUsers();
  /// A patient with a left foot and one wound.
  struct Wounded {
    Patient patient;
    Foot foot;
    Wound wound;
  };
  [[nodiscard]] static Wounded addWounded(Store& store, const std::string& family);
  [[nodiscard]] std::filesystem::path writeSource(const std::string& name, const std::string& text);

  TemporaryFolder folder_;
  StorePlace place_;
  std::shared_ptr<std::int64_t> now_ms_ = std::make_shared<std::int64_t>(1767225600000);  // 2026
  std::string recovery_code_;
  int stores_ = 0;
};

[[nodiscard]] std::string engineName(const testing::TestParamInfo<Database::Engine>& info);

}  // namespace tarsus

#define TARSUS_ON_BOTH_ENGINES(Suite) \
  INSTANTIATE_TEST_SUITE_P(           \
      , Suite, testing::Values(Database::Engine::Sqlite, Database::Engine::Postgres), engineName)
