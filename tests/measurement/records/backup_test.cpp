#include "measurement/records/backup.h"

#include "measurement/records/check.h"
#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/records/postgres_server.h"
#include "tests/measurement/records/record_test.h"

#include <filesystem>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

class Backup : public RecordTest {
 protected:
  void SetUp() override {
    RecordTest::SetUp();
    if (IsSkipped()) {
      return;
    }
    Store store = openAs("nils");
    const Wounded wounded = addWounded(store, "Berg");
    file_ = must(store.files().put(store.vault(), writeSource("model.ply", "a model")));
    VisitContent content = sampleVisit(*now_ms_, "first");
    content.files = {{.role = "model", .name = file_, .title = "model.ply"}};
    must(addVisit(store, wounded.wound.id, content));
    patient_ = wounded.patient.id;
  }
  fs::path backup_ = folder_.path() / "backup";
  std::string file_;
  std::string patient_;
};
TARSUS_ON_BOTH_ENGINES(Backup);

/// Into the other engine too: the copy is of one kind whichever it came from.
TEST_P(Backup, GivesTheWholeStoreBackIntoEitherEngine) {
  Store store = openAs("anna");
  const BackupSummary summary = must(backUp(store, backup_));
  EXPECT_EQ(summary.files, 3U);  // tables, anchor, model
  std::vector<StorePlace> places{{.folder = folder_.path() / "again"}};
  if (PostgresServer::instance().missing().empty()) {
    places.push_back({.folder = folder_.path() / "server",
                      .postgres = PostgresServer::instance().newDatabase()});
  }
  for (const StorePlace& place : places) {
    must(restore(backup_, place));
    expectFails(restore(backup_, place), ErrorCode::BadOption);
    Store again = must(Store::open(place, testEnvironment(clock(), "ward 1")));
    must(signIn(again, "petra", kPassword));
    const PatientHistory history = must(patientHistory(again, patient_));
    ASSERT_EQ(history.visits.size(), 1U);
    EXPECT_EQ(history.visits[0].content.fields["notes"], "first");
    must(again.files().get(again.vault(), file_, folder_.path() / "out"));
    const StoreCheck checked = must(checkStore(again));
    EXPECT_TRUE(checked.findings.empty()) << checked.findings.front();
    must(resetPassword(again, "nils", recovery_code_, "another password"));
  }
}

TEST_P(Backup, WorkGoesOnWhileAnotherStationIsOpen) {
  Store writer = openAs("nils", "ward 2");
  Store store = openAs("anna");
  must(backUp(store, backup_));
  must(addPatient(writer, named("Tal", "Ida")));
  must(verifyBackup(backup_));
  EXPECT_TRUE(must(checkStore(store)).findings.empty());
}

TEST_P(Backup, ADamagedOrMissingFileIsNamed) {
  Store store = openAs("anna");
  must(backUp(store, backup_));
  for (const fs::path& file :
       {fs::path("records.sqlite"), fs::path("files") / file_.substr(0, 2) / file_.substr(2)}) {
    const std::string whole = readTextFile(backup_ / file).value();
    ASSERT_TRUE(writeTextAtomically(backup_ / file, whole + "x"));
    const auto verified = verifyBackup(backup_);
    expectFails(verified, ErrorCode::StoreDamaged);
    EXPECT_NE(verified.error().detail.find(file.string()), std::string::npos);
    expectFails(restore(backup_, {.folder = folder_.path() / "again"}), ErrorCode::StoreDamaged);
    fs::remove(backup_ / file);
    expectFails(verifyBackup(backup_), ErrorCode::FileMissing);
    ASSERT_TRUE(writeTextAtomically(backup_ / file, whole));
  }
  must(verifyBackup(backup_));
  ASSERT_TRUE(writeTextAtomically(backup_ / "manifest.json",
                                  R"({"format":"tarsus-backup-1","files":[{"path":"../../x",)"
                                  R"("bytes":1,"sha256":"00"}]})"));
  expectFails(verifyBackup(backup_), ErrorCode::StoreDamaged);
}

TEST_P(Backup, AStoreWithAMissingFileIsNotBackedUp) {
  Store store = openAs("anna");
  fs::remove(store.files().pathOf(file_));
  expectFails(backUp(store, backup_), ErrorCode::FileMissing);
  EXPECT_FALSE(fs::exists(backup_ / "manifest.json"));
}

TEST_P(Backup, NeedsAnEmptyFolderAndThePermission) {
  Store store = openAs("rita");
  expectFails(backUp(store, backup_), ErrorCode::NotPermitted);
  must(signIn(store, "anna", kPassword));
  expectFails(backUp(store, place_.folder), ErrorCode::BadOption);
}

}  // namespace
}  // namespace tarsus
