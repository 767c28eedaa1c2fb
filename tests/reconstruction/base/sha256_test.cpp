#include "reconstruction/base/sha256.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace tarsus {
namespace {

std::string sumOf(const std::string& text) {
  Sha256 sum;
  sum.update(std::as_bytes(std::span(text)));
  return sum.hex();
}

// Vectors: NIST FIPS 180-4 examples (csrc.nist.gov, "Examples with Intermediate Values").
TEST(Sha256, AgreesWithThePublishedVectors) {
  EXPECT_EQ(sumOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sumOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sumOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sumOf(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesAddUpToTheWhole) {
  const std::string text(1000, 'x');
  Sha256 sum;
  for (std::size_t start = 0; start < text.size(); start += 77) {
    const std::string piece = text.substr(start, 77);
    sum.update(std::as_bytes(std::span(piece)));
  }
  Sha256 moved = std::move(sum);
  EXPECT_EQ(moved.hex(), sumOf(text));
}

}  // namespace
}  // namespace tarsus
