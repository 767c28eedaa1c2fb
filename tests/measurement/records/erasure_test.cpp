#include "measurement/records/check.h"
#include "measurement/records/removal.h"
#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/records/record_test.h"

#include <filesystem>

namespace tarsus {
namespace {

using ErasurePatient = RecordTest;
TARSUS_ON_BOTH_ENGINES(ErasurePatient);

VisitContent withFiles(std::int64_t at_ms, const std::vector<std::string>& names) {
  VisitContent content = sampleVisit(at_ms, "notes");
  for (const std::string& name : names) {
    content.files.push_back({.role = "model", .name = name, .title = "model.ply"});
  }
  return content;
}

TEST_P(ErasurePatient, LeavesATombstoneAndNothingElse) {
  Store nurse = openAs("nils");
  const Wounded erased = addWounded(nurse, "Berg");
  const Wounded other = addWounded(nurse, "Tal");
  const std::string own = must(nurse.files().put(nurse.vault(), writeSource("a", "own model")));
  const std::string shared = must(nurse.files().put(nurse.vault(), writeSource("b", "shared")));
  Visit visit = must(addVisit(nurse, erased.wound.id, withFiles(*now_ms_, {own, shared})));
  must(editVisit(nurse, visit.id, 1, withFiles(*now_ms_, {})));  // earlier versions count too
  must(addVisit(nurse, other.wound.id, withFiles(*now_ms_, {shared})));
  EXPECT_EQ(must(searchPatients(nurse, "berg")).size(), 1U);

  expectFails(erasePatient(nurse, erased.patient.id, "asked for"), ErrorCode::NotPermitted);
  Store store = openAs("anna", "office");
  expectFails(erasePatient(store, erased.patient.id, ""), ErrorCode::RecordInvalid);
  const Erasure done = must(erasePatient(store, erased.patient.id, "asked for"));
  EXPECT_EQ(done.records, 4U);
  EXPECT_EQ(done.files, 1U);
  EXPECT_TRUE(done.warnings.empty());

  expectFails(findPatient(nurse, erased.patient.id), ErrorCode::RecordMissing);
  expectFails(visitVersions(nurse, visit.id), ErrorCode::RecordMissing);
  EXPECT_TRUE(must(searchPatients(nurse, "berg")).empty());  // also on the other station
  EXPECT_FALSE(std::filesystem::exists(store.files().pathOf(own)));
  EXPECT_EQ(must(patientHistory(nurse, other.patient.id)).visits.size(), 1U);
  for (const SqlRow& row : must(store.database().query(
           "SELECT v.sealed FROM revisions v JOIN records r ON r.id = v.record WHERE r.state = "
           "'erased'"))) {
    EXPECT_TRUE(row.bytes(0).empty());
  }
  const StoreCheck checked = must(checkStore(store));
  EXPECT_TRUE(checked.findings.empty()) << checked.findings.front();
  int tombstones = 0;
  for (const AuditEntry& entry : must(auditEntries(store.database(), store.vault(), 1, 1000))) {
    tombstones += entry.action == "erase" && entry.details == "asked for" ? 1 : 0;
  }
  EXPECT_EQ(tombstones, 4);
  expectFails(erasePatient(store, erased.patient.id, "again"), ErrorCode::RecordMissing);
}

TEST_P(ErasurePatient, TakesTheMergedDuplicateAlong) {
  Store store = openAs("petra");
  const Wounded kept = addWounded(store, "Berg");
  const Wounded twice = addWounded(store, "Bergh");
  must(mergePatients(store, kept.patient.id, twice.patient.id, 1, "same person"));
  Store office = openAs("anna", "office");
  EXPECT_EQ(must(erasePatient(office, kept.patient.id, "asked for")).records, 6U);
  expectFails(findPatient(store, twice.patient.id), ErrorCode::RecordMissing);
}

}  // namespace
}  // namespace tarsus
