#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <string>
#include <string_view>

namespace tarsus {

inline constexpr std::size_t kShortestPassword = 8;

/// Whether the store has no user yet, so that firstRun() comes first.
[[nodiscard]] Expected<bool> isNewStore(Store& store);

/// Makes the store key and the first administrator, and signs him or her in.
/// @return the recovery code: shown and printed now, and never again
/// @errors StepNotAllowed (there are users already), RecordInvalid (name or password)
[[nodiscard]] Expected<std::string> firstRun(Store& store,
                                             std::string_view name,
                                             std::string_view password);

/// After three wrong passwords in a row each further attempt waits twice as long, 4 s to 15 min.
/// @errors PasswordWrong (also for a name that is not known), SignInDelayed, StoreDamaged
[[nodiscard]] Expected<SignedIn> signIn(Store& store,
                                        std::string_view name,
                                        std::string_view password);

/// @errors PasswordWrong, RecordInvalid (too short), StoreLocked
[[nodiscard]] Expected<void> changePassword(Store& store,
                                            std::string_view old_password,
                                            std::string_view new_password);

/// A forgotten password: the recovery code opens the store and gives the user a new one.
/// @errors PasswordWrong (saying which group was mistyped), SignInDelayed, RecordInvalid
[[nodiscard]] Expected<SignedIn> resetPassword(Store& store,
                                               std::string_view name,
                                               std::string_view recovery_code,
                                               std::string_view new_password);

/// Another code; the one printed before opens nothing any more. Administrators only.
[[nodiscard]] Expected<std::string> renewRecoveryCode(Store& store);

/// Puts a user's wrapped key into the table; for users.cpp.
[[nodiscard]] Expected<void> writeUserKey(Store& store,
                                          std::string_view name,
                                          std::string_view user_id,
                                          std::string_view password);
[[nodiscard]] Expected<void> removeUserKey(Store& store, std::string_view name);

}  // namespace tarsus
