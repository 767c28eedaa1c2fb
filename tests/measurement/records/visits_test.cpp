#include "measurement/records/visits.h"

#include "measurement/records/removal.h"
#include "tests/measurement/records/record_test.h"

#include <thread>

namespace tarsus {
namespace {

using Visits = RecordTest;
TARSUS_ON_BOTH_ENGINES(Visits);

TEST_P(Visits, GoFromDraftToReviewedAndKeepEachVersion) {
  Store nurse = openAs("nils");
  Store physician = openAs("petra", "ward 2");
  const Wounded wounded = addWounded(nurse, "Berg");
  Visit visit = must(addVisit(nurse, wounded.wound.id, sampleVisit(*now_ms_, "first")));
  EXPECT_EQ(visit.state, VisitState::Draft);
  visit = must(editVisit(nurse, visit.id, 1, sampleVisit(*now_ms_, "second")));
  EXPECT_EQ(visit.state, VisitState::Draft);
  *now_ms_ += 1000;
  visit = must(stepVisit(nurse, visit.id, 2, VisitStep::Sign));
  EXPECT_EQ(visit.signed_at_ms, *now_ms_);
  EXPECT_EQ(must(visitsToReview(physician)).size(), 1U);
  // Signed is locked: no change without a reason.
  expectFails(editVisit(nurse, visit.id, 3, sampleVisit(*now_ms_, "third")),
              ErrorCode::RecordInvalid);
  expectFails(stepVisit(nurse, visit.id, 3, VisitStep::Review), ErrorCode::NotPermitted);
  visit = must(stepVisit(physician, visit.id, 3, VisitStep::Return, "which toe?"));
  EXPECT_TRUE(must(visitsToReview(physician)).empty());
  expectFails(stepVisit(physician, visit.id, 4, VisitStep::Review), ErrorCode::StepNotAllowed);
  visit = must(editVisit(nurse, visit.id, 4, sampleVisit(*now_ms_, "third"), "toe added"));
  EXPECT_EQ(visit.state, VisitState::Amended);
  visit = must(stepVisit(physician, visit.id, 5, VisitStep::Review));
  EXPECT_EQ(visit.state, VisitState::Reviewed);
  const auto versions = must(visitVersions(nurse, visit.id));
  ASSERT_EQ(versions.size(), 6U);
  EXPECT_EQ(versions[0].content.fields["notes"], "first");
  EXPECT_EQ(versions[1].content.fields["notes"], "second");
  EXPECT_EQ(versions[3].reason, "which toe?");
  EXPECT_EQ(versions[4].reason, "toe added");
  EXPECT_EQ(versions[5].content.fields["notes"], "third");
  EXPECT_NE(versions[5].signed_by, versions[5].author);
}

TEST_P(Visits, AStaleStepIsToldAndChangesNothing) {
  Store nurse = openAs("nils");
  Store physician = openAs("petra", "ward 2");
  const Wounded wounded = addWounded(nurse, "Berg");
  const Visit visit = must(addVisit(nurse, wounded.wound.id, sampleVisit(*now_ms_, "first")));
  must(stepVisit(nurse, visit.id, 1, VisitStep::Sign));
  expectFails(editVisit(physician, visit.id, 1, sampleVisit(*now_ms_, "lost?")),
              ErrorCode::RecordStale);
  expectFails(stepVisit(physician, visit.id, 1, VisitStep::Sign), ErrorCode::RecordStale);
  EXPECT_EQ(must(findVisit(physician, visit.id)).content.fields["notes"], "first");
}

TEST_P(Visits, MovingASignedVisitIsAnAmendmentWithAReason) {
  Store store = openAs("nils");
  const Wounded wrong = addWounded(store, "Berg");
  const Wounded right = addWounded(store, "Tal");
  const Visit visit = must(addVisit(store, wrong.wound.id, sampleVisit(*now_ms_, "first")));
  must(stepVisit(store, visit.id, 1, VisitStep::Sign));
  expectFails(moveVisit(store, visit.id, 2, right.wound.id, ""), ErrorCode::RecordInvalid);
  expectFails(moveVisit(store, visit.id, 2, "W-NONE", "wrong patient"), ErrorCode::RecordMissing);
  const Visit moved = must(moveVisit(store, visit.id, 2, right.wound.id, "wrong patient"));
  EXPECT_EQ(moved.state, VisitState::Amended);
  EXPECT_EQ(moved.last_action, "move");
  EXPECT_TRUE(must(patientHistory(store, wrong.patient.id)).visits.empty());
  EXPECT_EQ(must(patientHistory(store, right.patient.id)).visits.size(), 1U);
  EXPECT_EQ(must(visitVersions(store, visit.id))[0].wound_id, wrong.wound.id);
}

TEST_P(Visits, WithoutUsableScanHoldTypedValuesAndAPicture) {
  Store store = openAs("nils");
  const Wounded wounded = addWounded(store, "Berg");
  const std::string name =
      must(store.files().put(store.vault(), writeSource("wound.jpg", "a photograph")));
  VisitContent content{.taken_at_ms = *now_ms_,
                       .usable_scan = false,
                       .files = {{.role = "picture", .name = name, .title = "wound.jpg"}}};
  expectFails(addVisit(store, wounded.wound.id, content), ErrorCode::RecordInvalid);
  content.fields = {{"ruler_length_mm", 12}, {"ruler_width_mm", 9}, {"probe_depth_mm", 3}};
  const Visit visit = must(addVisit(store, wounded.wound.id, content));
  EXPECT_FALSE(visit.content.usable_scan);
  EXPECT_EQ(visit.content.files.at(0).name, name);
  content.files[0].name = std::string(64, '0');
  expectFails(editVisit(store, visit.id, 1, content), ErrorCode::RecordInvalid);
}

TEST_P(Visits, MeasurementsAreRevisionsOfTheirVisit) {
  Store store = openAs("nils");
  const Wounded wounded = addWounded(store, "Berg");
  const Visit visit = must(addVisit(store, wounded.wound.id, sampleVisit(*now_ms_, "first")));
  Measurement measurement{.visit_id = visit.id,
                          .numbers = {{"opening_area_mm2", 0.1 + 0.2}},
                          .outline = {{"points", {1.5, 2.5}}},
                          .scan_sha256 = "ab"};
  must(addMeasurement(store, 1, measurement));
  expectFails(addMeasurement(store, 1, measurement), ErrorCode::RecordStale);
  must(stepVisit(store, visit.id, 2, VisitStep::Sign));
  expectFails(addMeasurement(store, 3, measurement), ErrorCode::RecordInvalid);
  must(addMeasurement(store, 3, measurement, "outline mended"));
  const auto measured = must(measurementsOf(store, visit.id));
  ASSERT_EQ(measured.size(), 2U);
  EXPECT_EQ(measured[0].numbers["opening_area_mm2"].get<double>(), 0.1 + 0.2);  // to the bit
  EXPECT_EQ(must(findVisit(store, visit.id)).state, VisitState::Amended);
}

TEST_P(Visits, ASignedVisitIsTrashedWithAReasonOnly) {
  Store store = openAs("nils");
  const Wounded wounded = addWounded(store, "Berg");
  const Visit visit = must(addVisit(store, wounded.wound.id, sampleVisit(*now_ms_, "first")));
  must(stepVisit(store, visit.id, 1, VisitStep::Sign));
  expectFails(moveToTrash(store, RecordKind::Visit, visit.id, 2), ErrorCode::RecordInvalid);
  must(moveToTrash(store, RecordKind::Visit, visit.id, 2, "test entry"));
  EXPECT_TRUE(must(visitsToReview(store)).empty());
  expectFails(stepVisit(store, visit.id, 3, VisitStep::Sign), ErrorCode::StepNotAllowed);
}

/// Two stations add one to the same counter; each increment must survive, stale ones are tried
/// again. Fewer here than in many_test.cpp.
TEST_P(Visits, TwoStationsEditingAtOnceLoseNothing) {
  constexpr int kEdits = 25;
  Store store = openAs("nils");
  const Wounded wounded = addWounded(store, "Berg");
  const Visit visit = must(addVisit(store, wounded.wound.id, sampleVisit(*now_ms_, "0")));
  const auto work = [&](const char* station) {
    Store mine = openAs("nils", station);
    for (int done = 0; done < kEdits;) {
      const Visit now = must(findVisit(mine, visit.id));
      VisitContent content = now.content;
      content.fields["notes"] =
          std::to_string(std::stoi(content.fields["notes"].get<std::string>()) + 1);
      const auto edited = editVisit(mine, visit.id, now.revision, content);
      if (edited) {
        ++done;
      } else if (edited.error().code != ErrorCode::RecordStale) {
        ADD_FAILURE() << describe(edited.error());
        return;
      }
    }
  };
  std::thread one(work, "ward 1");
  std::thread two(work, "ward 2");
  one.join();
  two.join();
  EXPECT_EQ(must(findVisit(store, visit.id)).content.fields["notes"], std::to_string(2 * kEdits));
  EXPECT_EQ(must(visitVersions(store, visit.id)).size(), 2U * kEdits + 1);
}

}  // namespace
}  // namespace tarsus
