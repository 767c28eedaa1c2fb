#include "measurement/records/audit.h"

#include "measurement/records/check.h"
#include "tests/measurement/records/record_test.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace tarsus {
namespace {

class Audit : public RecordTest {
 protected:
  void SetUp() override {
    RecordTest::SetUp();
    if (IsSkipped()) {
      return;
    }
    Store store = openAs("nils");
    for (const char* name : {"Berg", "Tal", "See"}) {
      must(addPatient(store, named(name, "Ida")));
    }
  }
  AuditVerdict verify() {
    Store store = openStore();
    must(signIn(store, "rita", kPassword));
    return must(verifyAudit(store.database(), store.vault(), store.anchorFile()));
  }
  /// Behind the program's back.
  void tamper(const std::string& sql) {
    Store store = openStore();
    must(store.database().execute(sql));
  }
};
TARSUS_ON_BOTH_ENGINES(Audit);

TEST_P(Audit, SaysWhoDidWhatWhenAndWhere) {
  Store store = openAs("nils", "ward 7");
  *now_ms_ += 5;
  const Patient patient = must(addPatient(store, named("Fluss", "Ida")));
  const auto entries = must(auditEntries(store.database(), store.vault(), 1, 1000));
  const AuditEntry& last = entries.back();
  EXPECT_EQ(last.entry, static_cast<std::int64_t>(entries.size()));
  EXPECT_EQ(last.at_ms, *now_ms_);
  EXPECT_EQ(last.station, "ward 7");
  EXPECT_EQ(last.action, "patient add");
  EXPECT_EQ(last.subject, patient.id);
  EXPECT_EQ(last.revision, 1);
  const AuditVerdict verdict = verify();
  EXPECT_FALSE(verdict.broken_at);
  EXPECT_EQ(verdict.not_anchored, 0);
  EXPECT_TRUE(verdict.finding.empty());
}

TEST_P(Audit, FindsTheFirstChangedEntryWhateverColumnIt) {
  for (const char* change : {"at_ms = at_ms + 1",
                             "who = 'U-OTHER'",
                             "station = 'elsewhere'",
                             "action = 'nothing'",
                             "subject = 'P-OTHER'",
                             "revision = revision + 1",
                             "digest = hash",
                             "details = hash",
                             "hash = digest"}) {
    Store store = openAs("rita");
    const Transaction gone_after = must(Transaction::begin(store.database()));
    must(store.database().execute(std::string("UPDATE audit SET ") + change + " WHERE entry = 7"));
    const auto verdict = must(verifyAudit(store.database(), store.vault(), store.anchorFile()));
    EXPECT_EQ(verdict.broken_at, 7) << change;
  }
}

TEST_P(Audit, FindsARemovedEntry) {
  tamper("DELETE FROM audit WHERE entry = 6");
  EXPECT_EQ(verify().broken_at, 6);
}

TEST_P(Audit, FindsTheFirstEntryRemoved) {
  tamper("DELETE FROM audit WHERE entry = 1");
  EXPECT_EQ(verify().broken_at, 1);
}

TEST_P(Audit, FindsTwoEntriesThatChangedPlaces) {
  tamper("UPDATE audit SET entry = 1000 WHERE entry = 6");
  tamper("UPDATE audit SET entry = 6 WHERE entry = 7");
  tamper("UPDATE audit SET entry = 7 WHERE entry = 1000");
  EXPECT_EQ(verify().broken_at, 6);
}

/// The next entry is written onto the shortened chain, which then is whole in itself.
TEST_P(Audit, FindsATailCutOffByTheSecondPlace) {
  const std::int64_t entries = verify().entries;
  tamper("DELETE FROM audit WHERE entry >= " + std::to_string(entries - 1));
  const AuditVerdict verdict = verify();
  EXPECT_TRUE(verdict.broken_at);
  EXPECT_NE(verdict.finding, "");
}

TEST_P(Audit, SaysWhenTheSecondPlaceIsMissingOrMakesNoSense) {
  for (const char* text : {"", "hello"}) {
    std::filesystem::remove(place_.folder / "audit.anchor");
    if (*text != '\0') {
      std::ofstream(place_.folder / "audit.anchor") << text;
    }
    Store store = openAs("nils");  // signing in and writing on do not cover it up
    must(addPatient(store, named("Fluss", "Ida")));
    const auto verdict = must(verifyAudit(store.database(), store.vault(), store.anchorFile()));
    EXPECT_FALSE(verdict.broken_at);
    EXPECT_EQ(verdict.not_anchored, verdict.entries);
    EXPECT_NE(verdict.finding.find("second place"), std::string::npos);
  }
}

/// Tables put back to an older state, and written on until they are longer than before.
TEST_P(Audit, FindsAnOlderStateThatWasWrittenOn) {
  const std::int64_t entries = verify().entries;
  tamper("DELETE FROM audit WHERE entry >= " + std::to_string(entries - 1));
  Store store = openAs("nils");
  for (int i = 0; i < 5; ++i) {
    must(addPatient(store, named("Fluss", "Ida")));
  }
  const auto verdict = must(verifyAudit(store.database(), store.vault(), store.anchorFile()));
  EXPECT_EQ(verdict.broken_at, entries);
  expectFails(acceptAuditTrail(store, "restored by hand"), ErrorCode::NotPermitted);
  must(signIn(store, "anna", kPassword));
  expectFails(acceptAuditTrail(store, "  "), ErrorCode::RecordInvalid);
  must(acceptAuditTrail(store, "restored by hand"));
  EXPECT_EQ(verify().finding, "");
  const auto all = must(auditEntries(store.database(), store.vault(), 1, 1000));
  const auto told = std::ranges::find(all, "accept the trail", &AuditEntry::action);
  ASSERT_NE(told, all.end());
  EXPECT_NE(told->details.find("restored by hand (found: entry"), std::string::npos);
}

}  // namespace
}  // namespace tarsus
