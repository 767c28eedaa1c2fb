#pragma once

#include "measurement/records/vault.h"

#include <string>
#include <string_view>

namespace tarsus {

/// What testing one password costs (argon2id); kept beside each wrapped key.
struct KeyCost {
  std::int64_t operations = 2;                         ///< libsodium's "interactive"
  std::int64_t memory_bytes = std::int64_t{64} << 20;  ///< the same: 64 MiB, 0.26 s
};

/// The store key as one password or recovery code opens it.
struct WrappedKey {
  Bytes salt;
  KeyCost cost;
  Bytes sealed;
};

/// @param holder  whose it is; a wrapped key opens under this name only
/// @errors StoreFailed (not enough memory for the cost asked)
[[nodiscard]] Expected<WrappedKey> wrapKey(const SecretKey& store_key,
                                           std::string_view password,
                                           std::string_view holder,
                                           const KeyCost& cost);
/// @errors PasswordWrong, StoreFailed
[[nodiscard]] Expected<SecretKey> unwrapKey(const WrappedKey& wrapped,
                                            std::string_view password,
                                            std::string_view holder);

/// 140 random bits in seven groups of five characters, the fifth of each a check of the group and
/// its place.
[[nodiscard]] std::string newRecoveryCode();
/// As printed, whatever the case, spaces and hyphens; I and L are read as 1, O as 0.
/// @errors PasswordWrong, naming the group that is not as printed
[[nodiscard]] Expected<std::string> readRecoveryCode(std::string_view typed);

}  // namespace tarsus
