#include "reconstruction/base/sha256.h"

#include "reconstruction/base/require.h"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <vector>

namespace tarsus {

struct Sha256::State {
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context{EVP_MD_CTX_new()};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  TARSUS_REQUIRE(EVP_DigestInit_ex(state_->context.get(), EVP_sha256(), nullptr) == 1,
                 "OpenSSL knows SHA-256");
}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

void Sha256::update(std::span<const std::byte> bytes) {
  EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size());
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> digest{};
  EVP_DigestFinal_ex(state_->context.get(), digest.data(), nullptr);
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

Expected<std::string> sha256OfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) {
    std::error_code error;
    return fail(
        std::filesystem::exists(path, error) ? ErrorCode::FileUnreadable : ErrorCode::FileMissing,
        path.string());
  }
  Sha256 sum;
  std::vector<char> chunk(std::size_t{1} << 20U);
  while (file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    sum.update(std::as_bytes(std::span(chunk.data(), static_cast<std::size_t>(file.gcount()))));
  }
  return file.bad() ? fail(ErrorCode::FileUnreadable, path.string())
                    : Expected<std::string>(sum.hex());
}

}  // namespace tarsus
