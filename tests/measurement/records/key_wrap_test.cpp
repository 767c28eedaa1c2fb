#include "measurement/records/key_wrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

namespace tarsus {
namespace {

constexpr KeyCost kCheap{.operations = 1, .memory_bytes = 8192};
constexpr std::string_view kLetters = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";

TEST(WrapKey, ThePasswordOpensItForItsHolderOnly) {
  const SecretKey key = SecretKey::random();
  WrappedKey wrapped = wrapKey(key, "secret words", "user:nils", kCheap).value();
  const auto opened = unwrapKey(wrapped, "secret words", "user:nils");
  ASSERT_TRUE(opened);
  EXPECT_TRUE(std::equal(key.data(), key.data() + SecretKey::kSize, opened->data()));
  EXPECT_EQ(unwrapKey(wrapped, "secret word", "user:nils").error().code, ErrorCode::PasswordWrong);
  EXPECT_FALSE(unwrapKey(wrapped, "secret words", "user:anna"));
  wrapped.cost.operations = 2;
  EXPECT_FALSE(unwrapKey(wrapped, "secret words", "user:nils"));
  wrapped.cost.operations = -1;
  EXPECT_EQ(unwrapKey(wrapped, "secret words", "user:nils").error().code, ErrorCode::StoreDamaged);
}

TEST(RecoveryCode, ReadsBackHoweverItIsTyped) {
  for (int i = 0; i < 50; ++i) {
    const std::string code = newRecoveryCode();
    ASSERT_EQ(code.size(), 7U * 5U + 6U);
    EXPECT_EQ(readRecoveryCode(code).value(), code);
    std::string typed = code;
    std::ranges::transform(typed, typed.begin(), [](char letter) {
      const int lower = std::tolower(static_cast<unsigned char>(letter));
      return letter == '-'   ? ' '
             : letter == '0' ? 'o'
             : letter == '1' ? 'l'
                             : static_cast<char>(lower);
    });
    EXPECT_EQ(readRecoveryCode(typed).value(), code);
  }
}

TEST(RecoveryCode, NamesTheGroupOfEachSingleWrongCharacter) {
  const std::string code = newRecoveryCode();
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] == '-') {
      continue;
    }
    for (const char letter : kLetters) {
      std::string typed = code;
      typed[i] = letter;
      if (typed == code) {
        continue;
      }
      const auto read = readRecoveryCode(typed);
      ASSERT_FALSE(read) << typed;
      EXPECT_NE(read.error().detail.find("group " + std::to_string(i / 6 + 1)), std::string::npos);
    }
  }
  EXPECT_FALSE(readRecoveryCode(code.substr(1)));
  EXPECT_FALSE(readRecoveryCode(""));
  EXPECT_FALSE(readRecoveryCode("U" + code.substr(1)));  // U is no letter of it
}

}  // namespace
}  // namespace tarsus
