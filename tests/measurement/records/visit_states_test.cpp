#include "measurement/records/visit_states.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

namespace tarsus {
namespace {

using enum VisitState;
using enum VisitStep;

/// The rule once more, in the words of the issue: draft -> signed -> returned -> amended ->
/// reviewed; a signed visit changes by amendment only; only a physician returns and reviews.
const std::map<std::tuple<VisitState, VisitStep>, VisitState> kRule{{{Draft, Edit}, Draft},
                                                                    {{Draft, Sign}, Signed},
                                                                    {{Signed, Return}, Returned},
                                                                    {{Signed, Amend}, Amended},
                                                                    {{Signed, Review}, Reviewed},
                                                                    {{Returned, Amend}, Amended},
                                                                    {{Amended, Return}, Returned},
                                                                    {{Amended, Amend}, Amended},
                                                                    {{Amended, Review}, Reviewed},
                                                                    {{Reviewed, Amend}, Amended}};

ErrorCode expectedRefusal(VisitState from, VisitStep step, Role role) {
  if (!kRule.contains({from, step})) {
    return ErrorCode::StepNotAllowed;
  }
  const bool clinician = role == Role::Nurse || role == Role::Physician;
  const bool physician_only = step == Return || step == Review;
  if (!clinician || (physician_only && role != Role::Physician)) {
    return ErrorCode::NotPermitted;
  }
  return ErrorCode::RecordInvalid;  // without a reason
}

TEST(VisitStates, EachStateStepRoleAndReasonGivesWhatTheRuleSays) {
  int allowed = 0;
  for (const VisitState from : kVisitStates) {
    for (const VisitStep step : kVisitSteps) {
      for (const Role role : kRoles) {
        for (const char* reason : {"", "the wrong toe"}) {
          const auto after = stateAfter(from, step, role, reason);
          const ErrorCode refusal = expectedRefusal(from, step, role);
          const bool needs_reason = step == Return || step == Amend;
          const bool refused = refusal != ErrorCode::RecordInvalid ||
                               (needs_reason && std::string_view(reason).empty());
          ASSERT_EQ(after.has_value(), !refused) << nameOf(from) << ' ' << nameOf(step);
          if (refused) {
            EXPECT_EQ(after.error().code, refusal) << nameOf(from) << ' ' << nameOf(step);
            EXPECT_FALSE(after.error().detail.empty());
          } else {
            EXPECT_EQ(*after, (kRule.at({from, step})));
            ++allowed;
          }
        }
      }
    }
  }
  // Draft edit and sign: 2 steps x 2 roles x 2; return 2 x 1 x 1; amend 4 x 2 x 1; review 2 x 1
  // x 2.
  EXPECT_EQ(allowed, 8 + 2 + 8 + 4);
}

TEST(VisitStates, HaveNamesThatReadBack) {
  for (const VisitState state : kVisitStates) {
    EXPECT_EQ(visitStateNamed(nameOf(state)), state);
  }
  EXPECT_FALSE(visitStateNamed("erased"));
}

TEST(Roles, ReadersWriteNothingAndOnlyAdministratorsEraseOrManage) {
  for (const Role role : kRoles) {
    EXPECT_TRUE(isAllowed(role, Permission::Read));
    EXPECT_EQ(isAllowed(role, Permission::Erase), role == Role::Administrator);
    EXPECT_EQ(isAllowed(role, Permission::ManageUsers), role == Role::Administrator);
    EXPECT_EQ(roleNamed(nameOf(role)), role);
  }
  EXPECT_FALSE(isAllowed(Role::ReadOnly, Permission::EditRecords));
  EXPECT_FALSE(isAllowed(Role::ReadOnly, Permission::Trash));
  EXPECT_FALSE(roleNamed("root"));
}

}  // namespace
}  // namespace tarsus
