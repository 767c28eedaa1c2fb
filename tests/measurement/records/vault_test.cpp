#include "measurement/records/vault.h"

#include <gtest/gtest.h>

#include <set>

namespace tarsus {
namespace {

TEST(Seal, OpensUnderItsOwnIdentityAndKeyOnly) {
  const SecretKey key = SecretKey::random();
  const Bytes sealed = seal(key, "Müller", "patient 1");
  EXPECT_EQ(openSealed(key, sealed, "patient 1").value(), "Müller");
  EXPECT_EQ(openSealed(key, sealed, "patient 2").error().code, ErrorCode::StoreDamaged);
  EXPECT_FALSE(openSealed(SecretKey::random(), sealed, "patient 1"));
  EXPECT_EQ(openSealed(key, seal(key, "", "x"), "x").value(), "");
}

TEST(Seal, EveryChangedOrMissingByteIsFound) {
  const SecretKey key = SecretKey::random();
  const Bytes sealed = seal(key, "heel, plantar", "wound 1");
  for (std::size_t i = 0; i < sealed.size(); ++i) {
    Bytes changed = sealed;
    changed[i] ^= 1U;
    EXPECT_FALSE(openSealed(key, changed, "wound 1")) << i;
    EXPECT_FALSE(openSealed(key, Bytes(sealed.begin(), sealed.begin() + i), "wound 1")) << i;
  }
}

TEST(Seal, TheSameTextNeverLooksTheSame) {
  const SecretKey key = SecretKey::random();
  EXPECT_NE(seal(key, "Smith", "a"), seal(key, "Smith", "a"));
}

TEST(DerivedKey, EachPurposeHasItsOwn) {
  const SecretKey store_key = SecretKey::random();
  std::set<std::string> hashes;
  for (const KeyPurpose purpose :
       {KeyPurpose::Fields, KeyPurpose::FileNames, KeyPurpose::Files, KeyPurpose::Audit}) {
    hashes.insert(hexOf(keyedHash(derivedKey(store_key, purpose), "x")));
    EXPECT_EQ(keyedHash(derivedKey(store_key, purpose), "x"),
              keyedHash(derivedKey(store_key, purpose), "x"));
  }
  EXPECT_EQ(hashes.size(), 4U);
}

TEST(Vault, LocksItselfAfterIdlingAndNotWhileTouched) {
  std::int64_t now_ms = 0;
  Vault vault([&] { return now_ms; }, 600000);
  EXPECT_EQ(vault.key(KeyPurpose::Fields).error().code, ErrorCode::StoreLocked);
  vault.unlock(SecretKey::random());
  now_ms = 599999;
  EXPECT_TRUE(vault.key(KeyPurpose::Fields));
  vault.touch();
  now_ms += 599999;
  EXPECT_FALSE(vault.isLocked());
  now_ms += 1;
  EXPECT_TRUE(vault.isLocked());
  vault.touch();  // too late: touching does not unlock
  EXPECT_EQ(vault.storeKey().error().code, ErrorCode::StoreLocked);
}

}  // namespace
}  // namespace tarsus
