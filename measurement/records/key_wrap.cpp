#include "measurement/records/key_wrap.h"

#include <sodium.h>

#include <cctype>

namespace tarsus {
namespace {

constexpr std::string_view kLetters = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr std::size_t kGroups = 7;
constexpr std::size_t kGroup = 5;  ///< the last character is the check

Expected<SecretKey> keyFromPassword(std::string_view password,
                                    const Bytes& salt,
                                    const KeyCost& cost) {
  SecretKey key;
  const bool usable = salt.size() == crypto_pwhash_SALTBYTES && cost.operations > 0 &&
                      cost.memory_bytes > 0 &&
                      cost.memory_bytes <= std::int64_t{4} << 30;  // a damaged row asks for more
  if (!usable) {
    return fail(ErrorCode::StoreDamaged, "the settings of a wrapped key");
  }
  const int result = crypto_pwhash(key.data(),
                                   SecretKey::kSize,
                                   password.data(),
                                   password.size(),
                                   salt.data(),
                                   static_cast<unsigned long long>(cost.operations),
                                   static_cast<std::size_t>(cost.memory_bytes),
                                   crypto_pwhash_ALG_ARGON2ID13);
  if (result != 0) {
    return fail(ErrorCode::StoreFailed,
                "testing a password takes " + std::to_string(cost.memory_bytes >> 20) +
                    " MiB of memory, which this computer does not give");
  }
  return key;
}

std::string identityOf(std::string_view holder) { return "store key of " + std::string(holder); }

/// Odd weights find each single wrong character; the group's number finds swapped groups.
char checkOf(std::string_view group, std::size_t number) {
  std::size_t sum = number;
  for (std::size_t i = 0; i + 1 < kGroup; ++i) {
    sum += (2 * i + 1) * kLetters.find(group[i]);
  }
  return kLetters[sum % kLetters.size()];
}

/// Zero where the character is none of ours.
char readLetter(char typed) {
  const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(typed)));
  if (letter == 'I' || letter == 'L') {
    return '1';
  }
  if (letter == 'O') {
    return '0';
  }
  return kLetters.find(letter) == std::string_view::npos ? '\0' : letter;
}

}  // namespace

Expected<WrappedKey> wrapKey(const SecretKey& store_key,
                             std::string_view password,
                             std::string_view holder,
                             const KeyCost& cost) {
  WrappedKey wrapped{.salt = Bytes(crypto_pwhash_SALTBYTES), .cost = cost};
  randombytes_buf(wrapped.salt.data(), wrapped.salt.size());
  const auto key = keyFromPassword(password, wrapped.salt, cost);
  if (!key) {
    return tl::unexpected(key.error());
  }
  const std::string_view plain(reinterpret_cast<const char*>(store_key.data()), SecretKey::kSize);
  wrapped.sealed = seal(*key, plain, identityOf(holder));
  return wrapped;
}

Expected<SecretKey> unwrapKey(const WrappedKey& wrapped,
                              std::string_view password,
                              std::string_view holder) {
  const auto key = keyFromPassword(password, wrapped.salt, wrapped.cost);
  if (!key) {
    return tl::unexpected(key.error());
  }
  auto plain = openSealed(*key, wrapped.sealed, identityOf(holder));
  if (!plain || plain->size() != SecretKey::kSize) {
    return fail(ErrorCode::PasswordWrong);
  }
  SecretKey store_key;
  std::copy(plain->begin(), plain->end(), store_key.data());
  sodium_memzero(plain->data(), plain->size());
  return store_key;
}

std::string newRecoveryCode() {
  std::string code;
  for (std::size_t group = 0; group < kGroups; ++group) {
    std::string letters;
    for (std::size_t i = 0; i + 1 < kGroup; ++i) {
      letters.push_back(kLetters[randombytes_uniform(static_cast<std::uint32_t>(kLetters.size()))]);
    }
    code += (group > 0 ? "-" : "") + letters + checkOf(letters, group);
  }
  return code;
}

Expected<std::string> readRecoveryCode(std::string_view typed) {
  std::string letters;
  for (const char character : typed) {
    if (std::isspace(static_cast<unsigned char>(character)) != 0 || character == '-') {
      continue;
    }
    const char letter = readLetter(character);
    if (letter == '\0') {
      return fail(ErrorCode::PasswordWrong,
                  "group " + std::to_string(letters.size() / kGroup + 1) +
                      " of the recovery code holds a character that no code has");
    }
    letters.push_back(letter);
  }
  if (letters.size() != kGroups * kGroup) {
    return fail(ErrorCode::PasswordWrong, "a recovery code has seven groups of five characters");
  }
  std::string code;
  for (std::size_t group = 0; group < kGroups; ++group) {
    const std::string part = letters.substr(group * kGroup, kGroup);
    if (part.back() != checkOf(part, group)) {
      return fail(ErrorCode::PasswordWrong,
                  "group " + std::to_string(group + 1) + " of the recovery code, \"" + part +
                      "\", is not as it was printed");
    }
    code += (group > 0 ? "-" : "") + part;
  }
  return code;
}

}  // namespace tarsus
