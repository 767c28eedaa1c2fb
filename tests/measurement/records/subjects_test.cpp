#include "measurement/records/removal.h"
#include "tests/measurement/records/record_test.h"

namespace tarsus {
namespace {

using Subjects = RecordTest;
TARSUS_ON_BOTH_ENGINES(Subjects);

TEST_P(Subjects, WhatIsSavedIsReadBackByAnotherStation) {
  Store store = openAs("nils");
  const Patient patient = must(addPatient(store,
                                          {.family_name = "Müller",
                                           .given_name = "王",
                                           .birth_date = "1950-02-28",
                                           .identifier = "'; --"}));
  const Foot foot =
      must(addFoot(store,
                   patient.id,
                   {.side = FootSide::Right, .missing_toes = {1, 2}, .forefoot_missing = false}));
  const Wound wound = must(addWound(store, foot.id, heelWound()));
  Store other = openAs("petra", "ward 2");
  const PatientHistory history = must(patientHistory(other, patient.id));
  EXPECT_EQ(history.patient.fields.family_name, "Müller");
  EXPECT_EQ(history.patient.fields.given_name, "王");
  EXPECT_EQ(history.patient.fields.identifier, "'; --");
  ASSERT_EQ(history.feet.size(), 1U);
  EXPECT_EQ(history.feet[0].fields.missing_toes, (std::vector<int>{1, 2}));
  EXPECT_EQ(history.feet[0].fields.side, FootSide::Right);
  ASSERT_EQ(history.wounds.size(), 1U);
  EXPECT_EQ(history.wounds[0].number, 1);
  EXPECT_EQ(history.wounds[0].fields.onset, "2025-11-02");
  EXPECT_EQ(history.wounds[0].id, wound.id);
}

TEST_P(Subjects, BadFieldsAreRefusedAndNothingIsSaved) {
  Store store = openAs("nils");
  expectFails(addPatient(store, {}), ErrorCode::RecordInvalid);
  for (const char* date : {"1950-02-30", "50-01-01", "1950-1-1", "today", "1950-13-01"}) {
    expectFails(addPatient(store, {.family_name = "A", .birth_date = date}),
                ErrorCode::RecordInvalid);
  }
  expectFails(addPatient(store, {.family_name = "\xff\xfe"}), ErrorCode::RecordInvalid);
  const Wounded wounded = addWounded(store, "Berg");
  expectFails(addFoot(store, wounded.patient.id, {.side = FootSide::Left}),
              ErrorCode::RecordInvalid);
  expectFails(addFoot(store, wounded.patient.id, {.side = FootSide::Right, .missing_toes = {6}}),
              ErrorCode::RecordInvalid);
  expectFails(addFoot(store, "P-NOBODY", {.side = FootSide::Right}), ErrorCode::RecordMissing);
  WoundFields fields = heelWound();
  fields.place = "knee";
  expectFails(addWound(store, wounded.foot.id, fields), ErrorCode::RecordInvalid);
  fields = heelWound();
  fields.healed_on = "2025-01-01";
  expectFails(addWound(store, wounded.foot.id, fields), ErrorCode::RecordInvalid);
  EXPECT_EQ(must(searchPatients(store, "")).size(), 0U);
  EXPECT_EQ(must(patientHistory(store, wounded.patient.id)).wounds.size(), 1U);
}

TEST_P(Subjects, LineageIsChecked) {
  Store store = openAs("nils");
  const Wounded wounded = addWounded(store, "Berg");
  const std::string& first = wounded.wound.id;
  WoundFields fields = heelWound();
  fields.parents = {first};
  expectFails(addWound(store, wounded.foot.id, fields), ErrorCode::RecordInvalid);
  fields.origin = WoundOrigin::Split;
  const Wound left = must(addWound(store, wounded.foot.id, fields));
  const Wound right = must(addWound(store, wounded.foot.id, fields));
  EXPECT_EQ(right.number, 3);
  fields.origin = WoundOrigin::Merged;
  expectFails(addWound(store, wounded.foot.id, fields), ErrorCode::RecordInvalid);
  fields.parents = {left.id, right.id};
  const Wound merged = must(addWound(store, wounded.foot.id, fields));
  EXPECT_EQ(must(findWound(store, merged.id)).fields.parents, fields.parents);
  fields.origin = WoundOrigin::Recurred;
  fields.parents = {merged.id};  // a ring: the first wound would come from its own descendant
  expectFails(editWound(store, first, 1, fields), ErrorCode::RecordInvalid);
  fields.parents = {"W-NOWHERE"};
  expectFails(editWound(store, first, 1, fields), ErrorCode::RecordMissing);
}

TEST_P(Subjects, SearchFoldsAccentsAndSeesOtherStations) {
  Store store = openAs("nils");
  Store other = openAs("petra", "ward 2");
  const Patient patient = must(addPatient(store, named("Müller-Łuczak", "Søren")));
  must(addPatient(store, named("Muster", "Eva")));
  EXPECT_EQ(must(searchPatients(other, "mu")).size(), 2U);
  EXPECT_EQ(must(searchPatients(other, "LUCZ sor")).size(), 1U);
  EXPECT_EQ(must(searchPatients(other, "1950")).size(), 2U);
  must(editPatient(store, patient.id, patient.revision, named("Berg", "Søren")));
  EXPECT_EQ(must(searchPatients(other, "lucz")).size(), 0U);
  EXPECT_EQ(must(searchPatients(other, "berg")).size(), 1U);
}

TEST_P(Subjects, AStaleEditIsToldWhoWhenAndWhereAndOverwritesNothing) {
  Store one = openAs("nils", "ward 1");
  Store two = openAs("petra", "ward 2");
  const Patient patient = must(addPatient(one, named("Berg", "Ida")));
  must(editPatient(two, patient.id, 1, named("Bergmann", "Ida")));
  const auto stale = editPatient(one, patient.id, 1, named("Berger", "Ida"));
  expectFails(stale, ErrorCode::RecordStale);
  EXPECT_NE(stale.error().detail.find("petra changed it at 2026-01-01 00:00:00 UTC from ward 2"),
            std::string::npos)
      << stale.error().detail;
  EXPECT_EQ(must(findPatient(one, patient.id)).fields.family_name, "Bergmann");
}

TEST_P(Subjects, TrashHidesWhatLiesBelowAndGivesItBack) {
  Store store = openAs("nils");
  const Wounded wounded = addWounded(store, "Berg");
  must(addVisit(store, wounded.wound.id, sampleVisit(*now_ms_, "one")));
  expectFails(moveToTrash(store, RecordKind::Wound, wounded.wound.id, 9), ErrorCode::RecordStale);
  must(moveToTrash(store, RecordKind::Wound, wounded.wound.id, 1));
  EXPECT_TRUE(must(patientHistory(store, wounded.patient.id)).visits.empty());
  expectFails(moveToTrash(store, RecordKind::Wound, wounded.wound.id, 2),
              ErrorCode::StepNotAllowed);
  expectFails(addVisit(store, wounded.wound.id, sampleVisit(*now_ms_, "two")),
              ErrorCode::StepNotAllowed);
  ASSERT_EQ(must(trash(store)).size(), 1U);
  must(takeFromTrash(store, RecordKind::Wound, wounded.wound.id, 2));
  EXPECT_EQ(must(patientHistory(store, wounded.patient.id)).visits.size(), 1U);
  must(moveToTrash(store, RecordKind::Patient, wounded.patient.id, 1));
  EXPECT_TRUE(must(searchPatients(store, "berg")).empty());
  Store reader = openAs("rita", "library");
  expectFails(takeFromTrash(reader, RecordKind::Patient, wounded.patient.id, 2),
              ErrorCode::NotPermitted);
}

TEST_P(Subjects, MergedPatientsAreReadAsOneUntilItIsUndone) {
  Store nurse = openAs("nils");
  const Wounded kept = addWounded(nurse, "Berg");
  const Wounded twice = addWounded(nurse, "Bergh");
  must(addVisit(nurse, kept.wound.id, sampleVisit(*now_ms_, "kept")));
  must(addVisit(nurse, twice.wound.id, sampleVisit(*now_ms_ + 1, "twice")));
  expectFails(mergePatients(nurse, kept.patient.id, twice.patient.id, 1, "same person"),
              ErrorCode::NotPermitted);
  Store store = openAs("petra");
  expectFails(mergePatients(store, kept.patient.id, twice.patient.id, 1, ""),
              ErrorCode::RecordInvalid);
  expectFails(mergePatients(store, kept.patient.id, kept.patient.id, 1, "x"),
              ErrorCode::StepNotAllowed);
  must(mergePatients(store, kept.patient.id, twice.patient.id, 1, "same person"));
  const PatientHistory both = must(patientHistory(store, kept.patient.id));
  EXPECT_EQ(both.visits.size(), 2U);
  EXPECT_EQ(both.feet.size(), 2U);
  ASSERT_EQ(both.merged.size(), 1U);
  EXPECT_EQ(both.merged[0].fields.family_name, "Bergh");
  EXPECT_EQ(must(searchPatients(store, "berg")).size(), 1U);
  expectFails(mergePatients(store, twice.patient.id, kept.patient.id, 1, "ring"),
              ErrorCode::StepNotAllowed);
  must(addVisit(nurse, twice.wound.id, sampleVisit(*now_ms_ + 2, "meanwhile")));
  must(undoMerge(store, twice.patient.id, 2, "two sisters"));
  expectFails(undoMerge(store, twice.patient.id, 3, "again"), ErrorCode::StepNotAllowed);
  EXPECT_EQ(must(patientHistory(store, kept.patient.id)).visits.size(), 1U);
  EXPECT_EQ(must(patientHistory(store, twice.patient.id)).visits.size(), 2U);
  EXPECT_EQ(must(searchPatients(store, "berg")).size(), 2U);
}

TEST_P(Subjects, AMovedWoundTakesItsVisitsAndTheNextNumber) {
  Store store = openAs("nils");
  const Wounded wrong = addWounded(store, "Berg");
  const Wounded right = addWounded(store, "Tal");
  must(addVisit(store, wrong.wound.id, sampleVisit(*now_ms_, "one")));
  expectFails(moveWound(store, wrong.wound.id, 1, right.foot.id, ""), ErrorCode::RecordInvalid);
  const Wound moved = must(moveWound(store, wrong.wound.id, 1, right.foot.id, "wrong patient"));
  EXPECT_EQ(moved.number, 2);
  EXPECT_TRUE(must(patientHistory(store, wrong.patient.id)).visits.empty());
  EXPECT_EQ(must(patientHistory(store, right.patient.id)).visits.size(), 1U);
}

}  // namespace
}  // namespace tarsus
