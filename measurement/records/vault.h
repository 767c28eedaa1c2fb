#pragma once

#include "measurement/records/database.h"
#include "reconstruction/base/error.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace tarsus {

/// Milliseconds since 1970, UTC; given in, so that tests have their own time.
using ClockMs = std::function<std::int64_t()>;

/// 32 secret bytes in memory that is never swapped out and is wiped at the end (libsodium).
class SecretKey {
 public:
  [[nodiscard]] static SecretKey random();
  SecretKey(SecretKey&&) noexcept;
  SecretKey& operator=(SecretKey&&) noexcept;
  SecretKey(const SecretKey&) = delete;
  SecretKey& operator=(const SecretKey&) = delete;
  ~SecretKey();
  static constexpr std::size_t kSize = 32;
  [[nodiscard]] unsigned char* data() { return bytes_; }
  [[nodiscard]] const unsigned char* data() const { return bytes_; }

  /// Memory of its own, zero; throws std::bad_alloc.
  SecretKey();

 private:
  unsigned char* bytes_;
};

/// One key for each purpose, so that no value of one can stand for another.
enum class KeyPurpose { Fields = 1, FileNames = 2, Files = 3, Audit = 4 };
[[nodiscard]] SecretKey derivedKey(const SecretKey& store_key, KeyPurpose purpose);

/// XChaCha20-Poly1305 with a random nonce in front.
/// @param identity  what the value belongs to; a value opens under its own identity only
[[nodiscard]] Bytes seal(const SecretKey& key, std::string_view plain, std::string_view identity);
/// @errors StoreDamaged (changed, cut short, or moved from another place)
[[nodiscard]] Expected<std::string> openSealed(const SecretKey& key,
                                               const Bytes& sealed,
                                               std::string_view identity);
/// Keyed BLAKE2b, 32 bytes: nobody without the key can make or recognise it.
[[nodiscard]] Bytes keyedHash(const SecretKey& key, std::string_view bytes);
[[nodiscard]] std::string hexOf(const Bytes& bytes);
/// Random identifier with a letter for its kind in front: 60 bits, in characters that are not
/// mistaken for each other (Crockford's base 32).
[[nodiscard]] std::string newId(char kind);

/// Holds the store key while somebody is signed in, and forgets it after a time without touch().
class Vault {
 public:
  /// @param idle_ms  time after the last touch() at which it locks itself; none: never
  Vault(ClockMs now_ms, std::optional<std::int64_t> idle_ms);

  void unlock(SecretKey store_key);
  void lock();
  /// Somebody is at work.
  void touch();
  [[nodiscard]] bool isLocked();
  /// The key of one purpose. @errors StoreLocked
  [[nodiscard]] Expected<const SecretKey*> key(KeyPurpose purpose);
  /// To wrap it for another user. @errors StoreLocked
  [[nodiscard]] Expected<const SecretKey*> storeKey();

 private:
  struct Keys {
    SecretKey store;
    std::array<SecretKey, 4> derived;
  };
  ClockMs now_ms_;
  std::optional<std::int64_t> idle_ms_;
  std::int64_t touched_ms_ = 0;
  std::optional<Keys> keys_;
};

}  // namespace tarsus
