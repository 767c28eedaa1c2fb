#pragma once

#include "measurement/records/roles.h"
#include "reconstruction/base/error.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tarsus {

enum class VisitState : std::uint8_t { Draft, Signed, Returned, Amended, Reviewed };
inline constexpr std::array kVisitStates{VisitState::Draft,
                                         VisitState::Signed,
                                         VisitState::Returned,
                                         VisitState::Amended,
                                         VisitState::Reviewed};

enum class VisitStep : std::uint8_t {
  Edit,    ///< write on in a draft
  Sign,    ///< from now on locked
  Return,  ///< the physician asks for a change
  Amend,   ///< a new version of what was signed; also `move` to another wound
  Review,  ///< countersign
};
inline constexpr std::array kVisitSteps{
    VisitStep::Edit, VisitStep::Sign, VisitStep::Return, VisitStep::Amend, VisitStep::Review};

[[nodiscard]] std::string_view nameOf(VisitState state);
[[nodiscard]] std::optional<VisitState> visitStateNamed(std::string_view name);
[[nodiscard]] std::string_view nameOf(VisitStep step);

/// The state after a step.
/// @errors StepNotAllowed (the table has no such step from there), NotPermitted (not this role),
/// RecordInvalid (the step needs a reason and there is none)
[[nodiscard]] Expected<VisitState> stateAfter(VisitState from,
                                              VisitStep step,
                                              Role role,
                                              std::string_view reason);

}  // namespace tarsus
