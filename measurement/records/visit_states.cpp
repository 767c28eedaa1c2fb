#include "measurement/records/visit_states.h"

#include "measurement/records/content.h"

#include <string>

namespace tarsus {
namespace {

constexpr std::array<std::string_view, kVisitStates.size()> kStateNames{
    "draft", "signed", "returned", "amended", "reviewed"};
constexpr std::array<std::string_view, kVisitSteps.size()> kStepNames{
    "edit", "sign", "return", "amend", "review"};

struct Allowed {
  VisitState from;
  VisitStep step;
  VisitState to;
  bool nurse;
  bool physician;
  bool needs_reason;
};

/// All that may happen to a visit; what is not here may not. Administrators and readers take no
/// part in it.
constexpr std::array kSteps{
    Allowed{VisitState::Draft, VisitStep::Edit, VisitState::Draft, true, true, false},
    Allowed{VisitState::Draft, VisitStep::Sign, VisitState::Signed, true, true, false},
    Allowed{VisitState::Signed, VisitStep::Return, VisitState::Returned, false, true, true},
    Allowed{VisitState::Signed, VisitStep::Amend, VisitState::Amended, true, true, true},
    Allowed{VisitState::Signed, VisitStep::Review, VisitState::Reviewed, false, true, false},
    Allowed{VisitState::Returned, VisitStep::Amend, VisitState::Amended, true, true, true},
    Allowed{VisitState::Amended, VisitStep::Return, VisitState::Returned, false, true, true},
    Allowed{VisitState::Amended, VisitStep::Amend, VisitState::Amended, true, true, true},
    Allowed{VisitState::Amended, VisitStep::Review, VisitState::Reviewed, false, true, false},
    Allowed{VisitState::Reviewed, VisitStep::Amend, VisitState::Amended, true, true, true},
};

}  // namespace

std::string_view nameOf(VisitState state) {
  return kStateNames.at(static_cast<std::size_t>(state));
}

std::string_view nameOf(VisitStep step) { return kStepNames.at(static_cast<std::size_t>(step)); }

std::optional<VisitState> visitStateNamed(std::string_view name) {
  for (const VisitState state : kVisitStates) {
    if (nameOf(state) == name) {
      return state;
    }
  }
  return std::nullopt;
}

Expected<VisitState> stateAfter(VisitState from,
                                VisitStep step,
                                Role role,
                                std::string_view reason) {
  const std::string wish(nameOf(step));
  for (const Allowed& allowed : kSteps) {
    if (allowed.from != from || allowed.step != step) {
      continue;
    }
    const bool permitted =
        (role == Role::Nurse && allowed.nurse) || (role == Role::Physician && allowed.physician);
    if (!permitted) {
      return fail(ErrorCode::NotPermitted,
                  "as " + std::string(nameOf(role)) + " you may not " + wish + " a visit");
    }
    if (allowed.needs_reason && isBlank(reason)) {
      return fail(ErrorCode::RecordInvalid, "to " + wish + " a visit needs a reason");
    }
    return allowed.to;
  }
  return fail(
      ErrorCode::StepNotAllowed,
      "a visit that is " + std::string(nameOf(from)) + " cannot take the step \"" + wish + "\"");
}

}  // namespace tarsus
