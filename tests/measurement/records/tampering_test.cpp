#include "measurement/records/check.h"
#include "measurement/records/revisions.h"
#include "tests/measurement/records/record_test.h"

#include <filesystem>

namespace tarsus {
namespace {

class Tampering : public RecordTest {
 protected:
  void SetUp() override {
    RecordTest::SetUp();
    if (IsSkipped()) {
      return;
    }
    Store store = openAs("nils");
    wounded_ = addWounded(store, "Berg");
    file_ = must(store.files().put(store.vault(), writeSource("model.ply", "a model")));
    VisitContent content = sampleVisit(*now_ms_, "first");
    content.files = {{.role = "model", .name = file_, .title = "model.ply"}};
    visit_ = must(addVisit(store, wounded_.wound.id, content));
    must(addMeasurement(store, 1, {.visit_id = visit_.id, .numbers = {{"volume_mm3", 12.0}}}));
  }
  /// The same, seen by this station alone and gone with what is returned: many in one store.
  [[nodiscard]] static Transaction tamperForNow(Store& store,
                                                const std::string& sql,
                                                const std::vector<SqlValue>& values) {
    Transaction change = must(Transaction::begin(store.database()));
    EXPECT_GT(must(store.database().execute(sql, values)), 0) << sql;
    return change;
  }
  void tamper(const std::string& sql, const std::vector<SqlValue>& values = {}) {
    Store store = openStore();
    ASSERT_GT(must(store.database().execute(sql, values)), 0) << sql;
  }
  StoreCheck check() {
    Store store = openAs("petra");
    return must(checkStore(store));
  }
  std::string idOf(const std::string& kind) {
    Store store = openStore();
    return must(store.database().query("SELECT id FROM records WHERE kind = ? ORDER BY entry",
                                       {kind}))
        .front()
        .text(0);
  }
  Wounded wounded_;
  Visit visit_;
  std::string file_;
};
TARSUS_ON_BOTH_ENGINES(Tampering);

TEST_P(Tampering, AnUntouchedStoreHasNoFindings) {
  const StoreCheck checked = check();
  EXPECT_TRUE(checked.findings.empty()) << checked.findings.front();
  EXPECT_EQ(checked.files, 1U);
  EXPECT_GE(checked.revisions, 9U);  // 4 users, patient, foot, wound, visit twice, measurement
}

TEST_P(Tampering, NoPlainNameOrNoteIsInTheTables) {
  Store store = openStore();
  for (const SqlRow& row : must(store.database().query("SELECT sealed FROM revisions"))) {
    const Bytes bytes = row.bytes(0);
    const std::string text(bytes.begin(), bytes.end());
    EXPECT_EQ(text.find("Berg"), std::string::npos);
    EXPECT_EQ(text.find("first"), std::string::npos);
  }
}

TEST_P(Tampering, ASealedContentMovedToAnotherRowOfItsKindIsFound) {
  for (const char* kind : {"patient", "foot", "wound", "visit", "measurement", "user"}) {
    const std::string victim = idOf(kind);
    Store store = openAs("petra");
    const Transaction gone_after = tamperForNow(
        store,
        "UPDATE revisions SET sealed = (SELECT sealed FROM revisions WHERE record = ? ORDER BY "
        "revision LIMIT 1) WHERE record = ?",
        {idOf(std::string(kind) == "patient" ? "foot" : "patient"), victim});
    const auto revisions = allRevisions(store, recordKindNamed(kind).value(), victim);
    expectFails(revisions, ErrorCode::StoreDamaged);
    EXPECT_NE(revisions.error().detail.find(victim), std::string::npos);
    EXPECT_FALSE(must(checkStore(store)).findings.empty()) << kind;
  }
}

TEST_P(Tampering, EachClearColumnOfARevisionIsBound) {
  for (const char* change : {"parent = 'W-OTHER'",
                             "state = 'reviewed'",
                             "trashed = 1",
                             "at_ms = at_ms + 1",
                             "author = 'U-OTHER'",
                             "station = 'elsewhere'",
                             "action = 'sign'"}) {
    Store store = openAs("petra");
    const Transaction gone_after = tamperForNow(
        store,
        std::string("UPDATE revisions SET ") + change + " WHERE record = ? AND revision = 2",
        {visit_.id});
    expectFails(findVisit(store, visit_.id), ErrorCode::StoreDamaged);
    EXPECT_FALSE(must(checkStore(store)).findings.empty()) << change;
  }
}

TEST_P(Tampering, TheStandingOfARecordIsCheckedAgainstItsLastRevision) {
  for (const char* change : {"parent = 'W-OTHER'", "state = 'signed'", "trashed = 1"}) {
    Store store = openAs("petra");
    const Transaction gone_after = tamperForNow(
        store, std::string("UPDATE records SET ") + change + " WHERE id = ?", {visit_.id});
    expectFails(findVisit(store, visit_.id), ErrorCode::StoreDamaged);
    EXPECT_FALSE(must(checkStore(store)).findings.empty()) << change;
  }
}

TEST_P(Tampering, GoingBackToAnEarlierRevisionIsFoundByTheCheck) {
  tamper(
      "UPDATE records SET revision = 1, entry = (SELECT entry FROM revisions WHERE record = "
      "records.id AND revision = 1) WHERE id = ?",
      {visit_.id});
  EXPECT_EQ(check().findings.size(), 1U);
  tamper("DELETE FROM revisions WHERE record = ? AND revision = 2", {visit_.id});
  const StoreCheck checked = check();
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_NE(checked.findings[0].find("revision 2 is missing"), std::string::npos);
}

TEST_P(Tampering, ContentEmptiedWithoutATombstoneIsFound) {
  tamper("UPDATE revisions SET sealed = ? WHERE record = ?", {Bytes(), visit_.id});
  tamper("UPDATE records SET state = 'erased' WHERE id = ?", {visit_.id});
  EXPECT_GE(check().findings.size(), 2U);
}

TEST_P(Tampering, ARoleCannotBeRaisedInTheTables) {
  tamper(
      "UPDATE key_wrap SET user_record = (SELECT user_record FROM key_wrap WHERE holder = "
      "'user:anna') WHERE holder = 'user:nils'");
  Store store = openStore();
  expectFails(signIn(store, "nils", kPassword), ErrorCode::PasswordWrong);
}

TEST_P(Tampering, AnotherUsersWrappedKeyDoesNotOpen) {
  tamper(
      "UPDATE key_wrap SET sealed = (SELECT sealed FROM key_wrap WHERE holder = 'user:nils'), "
      "salt = (SELECT salt FROM key_wrap WHERE holder = 'user:nils') WHERE holder = 'user:anna'");
  Store store = openStore();
  expectFails(signIn(store, "anna", kPassword), ErrorCode::PasswordWrong);
}

TEST_P(Tampering, AMissingFileIsNamed) {
  Store store = openAs("petra");
  std::filesystem::remove(store.files().pathOf(file_));
  const StoreCheck checked = must(checkStore(store));
  ASSERT_EQ(checked.findings.size(), 1U);
  EXPECT_NE(checked.findings[0].find(store.files().pathOf(file_).string()), std::string::npos);
}

}  // namespace
}  // namespace tarsus
