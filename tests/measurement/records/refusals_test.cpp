// What a record must not say, and what must stay as it was.
#include "measurement/records/audit.h"
#include "measurement/records/backup.h"
#include "measurement/records/removal.h"
#include "tests/measurement/records/record_test.h"

#include <algorithm>
#include <filesystem>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

using Refusals = RecordTest;
TARSUS_ON_BOTH_ENGINES(Refusals);

TEST_P(Refusals, DaysThatCannotBe) {
  Store store = openAs("nils");  // the clock stands at 1 January 2026
  PatientFields patient = named("Berg", "Ida");
  for (const char* born : {"2026-01-02", "1899-12-31", "9999-01-01", "2025-02-29"}) {
    patient.birth_date = born;
    expectFails(addPatient(store, patient), ErrorCode::RecordInvalid);
  }
  const Wounded ida = addWounded(store, "Berg");
  WoundFields wound = heelWound();
  for (const char* onset : {"2026-01-02", "1950-12-30"}) {  // to come; before the birth
    wound.onset = onset;
    expectFails(addWound(store, ida.foot.id, wound), ErrorCode::RecordInvalid);
  }
  const std::int64_t day_ms = 86'400'000;
  expectFails(addVisit(store, ida.wound.id, sampleVisit(*now_ms_ + 2 * day_ms, "")),
              ErrorCode::RecordInvalid);
  must(addVisit(store, ida.wound.id, sampleVisit(*now_ms_ + day_ms / 2, "")));  // another zone
}

TEST_P(Refusals, AWoundWhereThisFootHasNoSkin) {
  Store store = openAs("nils");
  const Wounded ida = addWounded(store, "Berg");
  const Foot right =
      must(addFoot(store, ida.patient.id, {.side = FootSide::Right, .missing_toes = {1}}));
  WoundFields toe = heelWound();
  toe.place = "toe_1";
  expectFails(addWound(store, right.id, toe), ErrorCode::RecordInvalid);
  toe.place = "toe_2";
  must(addWound(store, right.id, toe));
  must(editFoot(store,
                right.id,
                right.revision,
                {.side = FootSide::Right, .missing_toes = {1}, .forefoot_missing = true}));
  expectFails(addWound(store, right.id, toe), ErrorCode::RecordInvalid);
  WoundFields split = heelWound();
  split.origin = WoundOrigin::Split;
  split.parents = {ida.wound.id};  // of the left foot
  expectFails(addWound(store, right.id, split), ErrorCode::RecordInvalid);
  must(addWound(store, ida.foot.id, split));
}

TEST_P(Refusals, NamesThatForgeLines) {
  Store store = openAs("anna");
  for (const char* name : {"", " ", " nils2", "new\nline", "NILS", "\x1b[31mred"}) {
    expectFails(addUser(store, name, Role::Nurse, kPassword), ErrorCode::RecordInvalid);
  }
  expectFails(addUser(store, std::string(400, 'n'), Role::Nurse, kPassword),
              ErrorCode::RecordInvalid);
  must(addUser(store, "Siân O'Brien-李", Role::Nurse, kPassword));
  must(signIn(store, "nils", kPassword));
  expectFails(addPatient(store, named(" ", "")), ErrorCode::RecordInvalid);
  expectFails(addPatient(store, named("Berg\nNeu", "Ida")), ErrorCode::RecordInvalid);
}

TEST_P(Refusals, AnEmptyVisitIsNotSignedAndSpacesAreNoReason) {
  Store store = openAs("nils");
  const Wounded ida = addWounded(store, "Berg");
  const Visit empty = must(addVisit(store, ida.wound.id, {.taken_at_ms = *now_ms_}));
  expectFails(stepVisit(store, empty.id, empty.revision, VisitStep::Sign),
              ErrorCode::StepNotAllowed);
  Visit visit = must(addVisit(store, ida.wound.id, sampleVisit(*now_ms_, "a")));
  visit = must(stepVisit(store, visit.id, visit.revision, VisitStep::Sign));
  expectFails(editVisit(store, visit.id, visit.revision, sampleVisit(*now_ms_, "b"), " \t"),
              ErrorCode::RecordInvalid);
  expectFails(moveVisit(store, visit.id, visit.revision, ida.wound.id, "slip"),
              ErrorCode::RecordInvalid);  // it is there
}

TEST_P(Refusals, AWoundMovedAwayAndBackKeepsItsNumber) {
  Store store = openAs("nils");
  const Wounded ida = addWounded(store, "Berg");
  const Wound second = must(addWound(store, ida.foot.id, heelWound()));
  const Wounded other = addWounded(store, "Tal");
  ASSERT_EQ(second.number, 2);
  const Wound away =
      must(moveWound(store, second.id, second.revision, other.foot.id, "wrong patient"));
  EXPECT_EQ(away.number, 2);  // free there
  const Wound first =
      must(moveWound(store, ida.wound.id, ida.wound.revision, other.foot.id, "wrong patient"));
  EXPECT_EQ(first.number, 3);  // its own is taken there
  EXPECT_EQ(must(moveWound(store, first.id, first.revision, ida.foot.id, "it was right")).number,
            1);
  expectFails(moveWound(store, away.id, away.revision, other.foot.id, "again"),
              ErrorCode::RecordInvalid);
}

TEST_P(Refusals, OnlyPhotographsArePictures) {
  Store store = openAs("nils");
  expectFails(putPicture(store, writeSource("password.jpg", "a long password")),
              ErrorCode::RecordInvalid);
  expectFails(putPicture(store, folder_.path() / "none.jpg"), ErrorCode::FileMissing);
  const VisitFile file =
      must(putPicture(store, writeSource("wound.jpg", "\xff\xd8\xff\xe0 and so on")));
  EXPECT_EQ(file.role, "picture");
  EXPECT_EQ(file.title, "wound.jpg");
}

TEST_P(Refusals, ABackupInsideTheRecordsAndEachBackupIsAudited) {
  Store store = openAs("nils");
  expectFails(backUp(store, place_.folder / "backup"), ErrorCode::BadOption);
  EXPECT_FALSE(fs::exists(place_.folder / "backup"));
  must(backUp(store, folder_.path() / ("backup" + std::to_string(stores_))));
  const auto entries = must(auditEntries(store.database(), store.vault(), 1, 1000));
  EXPECT_NE(std::ranges::find(entries, "back up", &AuditEntry::action), entries.end());
}

/// Whoever empties the tables must not be covered up by new ones.
TEST_P(Refusals, EmptiedTablesBesideTheirFiles) {
  { Store store = openAs("nils"); }
  if (place_.postgres) {
    GTEST_SKIP() << "a server's tables are not emptied by a file";
  }
  for (const char* end : {"", "-wal", "-shm"}) {
    fs::remove(place_.folder / (std::string("records.sqlite") + end));
  }
  expectFails(Store::open(place_, testEnvironment(clock(), "ward 1")), ErrorCode::StoreDamaged);
}

}  // namespace
}  // namespace tarsus
