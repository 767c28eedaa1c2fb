#include "measurement/records/vault.h"

#include "reconstruction/base/require.h"

#include <sodium.h>

#include <new>
#include <utility>

namespace tarsus {
namespace {

constexpr std::string_view kLetters = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

void startSodium() {
  static const int started = sodium_init();  // 1: it was started before
  TARSUS_REQUIRE(started >= 0, "libsodium starts");
}

const unsigned char* bytesOf(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

}  // namespace

SecretKey::SecretKey() : bytes_(nullptr) {
  startSodium();
  bytes_ = static_cast<unsigned char*>(sodium_malloc(kSize));
  if (bytes_ == nullptr) {
    throw std::bad_alloc();
  }
  sodium_memzero(bytes_, kSize);
}

SecretKey SecretKey::random() {
  SecretKey key;
  randombytes_buf(key.bytes_, kSize);
  return key;
}

SecretKey::SecretKey(SecretKey&& other) noexcept : bytes_(std::exchange(other.bytes_, nullptr)) {}

SecretKey& SecretKey::operator=(SecretKey&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

SecretKey::~SecretKey() { sodium_free(bytes_); }  // wipes

SecretKey derivedKey(const SecretKey& store_key, KeyPurpose purpose) {
  static_assert(crypto_kdf_KEYBYTES == SecretKey::kSize);
  SecretKey key;
  crypto_kdf_derive_from_key(key.data(),
                             SecretKey::kSize,
                             static_cast<std::uint64_t>(purpose),
                             "tarsusst",
                             store_key.data());
  return key;
}

Bytes seal(const SecretKey& key, std::string_view plain, std::string_view identity) {
  constexpr std::size_t kNonce = crypto_aead_xchacha20poly1305_ietf_NPUBBYTES;
  Bytes sealed(kNonce + plain.size() + crypto_aead_xchacha20poly1305_ietf_ABYTES);
  randombytes_buf(sealed.data(), kNonce);
  crypto_aead_xchacha20poly1305_ietf_encrypt(sealed.data() + kNonce,
                                             nullptr,
                                             bytesOf(plain),
                                             plain.size(),
                                             bytesOf(identity),
                                             identity.size(),
                                             nullptr,
                                             sealed.data(),
                                             key.data());
  return sealed;
}

Expected<std::string> openSealed(const SecretKey& key,
                                 const Bytes& sealed,
                                 std::string_view identity) {
  constexpr std::size_t kNonce = crypto_aead_xchacha20poly1305_ietf_NPUBBYTES;
  constexpr std::size_t kOverhead = kNonce + crypto_aead_xchacha20poly1305_ietf_ABYTES;
  if (sealed.size() < kOverhead) {
    return fail(ErrorCode::StoreDamaged, "a sealed value was cut short");
  }
  std::string plain(sealed.size() - kOverhead, '\0');
  const int result =
      crypto_aead_xchacha20poly1305_ietf_decrypt(reinterpret_cast<unsigned char*>(plain.data()),
                                                 nullptr,
                                                 nullptr,
                                                 sealed.data() + kNonce,
                                                 sealed.size() - kNonce,
                                                 bytesOf(identity),
                                                 identity.size(),
                                                 sealed.data(),
                                                 key.data());
  if (result != 0) {
    return fail(ErrorCode::StoreDamaged, "a sealed value was changed or moved");
  }
  return plain;
}

Bytes keyedHash(const SecretKey& key, std::string_view bytes) {
  Bytes hash(crypto_generichash_BYTES);
  crypto_generichash(
      hash.data(), hash.size(), bytesOf(bytes), bytes.size(), key.data(), SecretKey::kSize);
  return hash;
}

std::string hexOf(const Bytes& bytes) {
  std::string text(bytes.size() * 2 + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), bytes.data(), bytes.size());
  text.pop_back();
  return text;
}

std::string newId(char kind) {
  startSodium();
  constexpr int kRandomLetters = 12;
  std::string id{kind, '-'};
  for (int i = 0; i < kRandomLetters; ++i) {
    id.push_back(kLetters[randombytes_uniform(static_cast<std::uint32_t>(kLetters.size()))]);
  }
  return id;
}

Vault::Vault(ClockMs now_ms, std::optional<std::int64_t> idle_ms)
    : now_ms_(std::move(now_ms)), idle_ms_(idle_ms) {}

void Vault::unlock(SecretKey store_key) {
  std::array<SecretKey, 4> derived{derivedKey(store_key, KeyPurpose::Fields),
                                   derivedKey(store_key, KeyPurpose::FileNames),
                                   derivedKey(store_key, KeyPurpose::Files),
                                   derivedKey(store_key, KeyPurpose::Audit)};
  keys_.emplace(Keys{std::move(store_key), std::move(derived)});
  touched_ms_ = now_ms_();
}

void Vault::lock() { keys_.reset(); }

void Vault::touch() {
  if (!isLocked()) {
    touched_ms_ = now_ms_();
  }
}

bool Vault::isLocked() {
  if (keys_ && idle_ms_ && now_ms_() - touched_ms_ >= *idle_ms_) {
    lock();
  }
  return !keys_;
}

Expected<const SecretKey*> Vault::key(KeyPurpose purpose) {
  if (isLocked()) {
    return fail(ErrorCode::StoreLocked);
  }
  return &keys_->derived.at(static_cast<std::size_t>(purpose) - 1);
}

Expected<const SecretKey*> Vault::storeKey() {
  if (isLocked()) {
    return fail(ErrorCode::StoreLocked);
  }
  return &keys_->store;
}

}  // namespace tarsus
