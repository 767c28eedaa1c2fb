#include "measurement/records/sign_in.h"

#include "measurement/records/audit.h"
#include "measurement/records/users.h"
#include "tests/measurement/records/record_test.h"

#include <algorithm>
#include <tuple>

namespace tarsus {
namespace {

using SignIn = RecordTest;
TARSUS_ON_BOTH_ENGINES(SignIn);

TEST_P(SignIn, NothingIsReadBeforeIt) {
  Store store = openStore();
  expectFails(searchPatients(store, "a"), ErrorCode::StoreLocked);
  expectFails(addPatient(store, named("Berg", "Ida")), ErrorCode::StoreLocked);
  expectFails(firstRun(store, "eve", kPassword), ErrorCode::StepNotAllowed);
}

TEST_P(SignIn, WrongPasswordAndUnknownNameGiveTheSameSentence) {
  Store store = openStore();
  const auto wrong = signIn(store, "nils", "not the password");
  const auto unknown = signIn(store, "nobody", kPassword);
  expectFails(wrong, ErrorCode::PasswordWrong);
  expectFails(unknown, ErrorCode::PasswordWrong);
  EXPECT_EQ(describe(wrong.error()), describe(unknown.error()));
  EXPECT_EQ(must(signIn(store, "nils", kPassword)).role, Role::Nurse);
}

TEST_P(SignIn, ManyWrongAttemptsMustWaitLongerEachTimeAndAreAudited) {
  Store store = openStore();
  for (int i = 0; i < 3; ++i) {
    expectFails(signIn(store, "nils", "wrong password"), ErrorCode::PasswordWrong);
  }
  expectFails(signIn(store, "nils", kPassword), ErrorCode::SignInDelayed);
  *now_ms_ += 3999;
  expectFails(signIn(store, "nils", kPassword), ErrorCode::SignInDelayed);
  *now_ms_ += 1;
  expectFails(signIn(store, "nils", "wrong again"), ErrorCode::PasswordWrong);
  *now_ms_ += 4000;  // it is 8 s now
  expectFails(signIn(store, "nils", kPassword), ErrorCode::SignInDelayed);
  must(signIn(store, "petra", kPassword));  // nobody else waits
  *now_ms_ += 4000;
  must(signIn(store, "nils", kPassword));
  const auto entries = must(auditEntries(store.database(), store.vault(), 1, 1000));
  EXPECT_EQ(entries.back().action, "sign in");
  EXPECT_EQ(entries.back().details, "after 4 wrong attempts");
}

TEST_P(SignIn, IdlingLocksKeysAndNames) {
  StoreEnvironment environment = testEnvironment(clock(), "ward 1");
  environment.idle_ms = 600000;
  Store store = must(Store::open(place_, environment));
  must(signIn(store, "nils", kPassword));
  must(addPatient(store, named("Berg", "Ida")));
  *now_ms_ += 500000;
  store.vault().touch();
  *now_ms_ += 500000;
  EXPECT_EQ(must(searchPatients(store, "berg")).size(), 1U);
  *now_ms_ += 100000;
  expectFails(searchPatients(store, "berg"), ErrorCode::StoreLocked);
  EXPECT_TRUE(store.nameIndex().find("berg", 9).empty());
  must(signIn(store, "nils", kPassword));
  EXPECT_EQ(must(searchPatients(store, "berg")).size(), 1U);
}

TEST_P(SignIn, ANewPasswordReplacesTheOldOne) {
  Store store = openAs("nils");
  expectFails(changePassword(store, "wrong one", "another password"), ErrorCode::PasswordWrong);
  expectFails(changePassword(store, kPassword, "short"), ErrorCode::RecordInvalid);
  must(changePassword(store, kPassword, "another password"));
  expectFails(signIn(store, "nils", kPassword), ErrorCode::PasswordWrong);
  must(signIn(store, "nils", "another password"));
  must(signIn(store, "anna", kPassword));
}

TEST_P(SignIn, TheRecoveryCodeGivesAForgottenPasswordBack) {
  Store store = openAs("nils");
  const Patient patient = must(addPatient(store, named("Berg", "Ida")));
  store.lock();
  std::string mistyped = recovery_code_;
  mistyped[7] = mistyped[7] == 'A' ? 'B' : 'A';
  const auto refused = resetPassword(store, "nils", mistyped, "a new password");
  expectFails(refused, ErrorCode::PasswordWrong);
  EXPECT_NE(refused.error().detail.find("group 2"), std::string::npos);
  must(resetPassword(store, "nils", recovery_code_, "a new password"));
  EXPECT_EQ(must(findPatient(store, patient.id)).fields.family_name, "Berg");
  must(signIn(store, "nils", "a new password"));
  expectFails(resetPassword(store, "nobody", recovery_code_, "a new password"),
              ErrorCode::PasswordWrong);
}

TEST_P(SignIn, ARenewedRecoveryCodeEndsTheOldOne) {
  Store store = openAs("nils");
  expectFails(renewRecoveryCode(store), ErrorCode::NotPermitted);
  must(signIn(store, "anna", kPassword));
  const std::string renewed = must(renewRecoveryCode(store));
  expectFails(resetPassword(store, "nils", recovery_code_, "a new password"),
              ErrorCode::PasswordWrong);
  must(resetPassword(store, "nils", renewed, "a new password"));
}

TEST_P(SignIn, ADeactivatedUserIsOutAtOnceAndTheLastAdministratorStays) {
  Store ward = openAs("nils", "ward 1");
  Store office = openAs("anna", "office");
  const auto users = must(listUsers(office));
  const User nils = *std::ranges::find(users, "nils", &User::name);
  const User anna = *std::ranges::find(users, "anna", &User::name);
  expectFails(changeUser(office, anna.id, anna.revision, Role::Nurse, true),
              ErrorCode::StepNotAllowed);
  must(changeUser(office, nils.id, nils.revision, Role::Nurse, false));
  expectFails(addPatient(ward, named("Berg", "Ida")), ErrorCode::StoreLocked);
  expectFails(signIn(ward, "nils", kPassword), ErrorCode::PasswordWrong);
}

TEST_P(SignIn, AnAdministratorGivesAccessBackWithANewPassword) {
  Store store = openAs("anna");
  const auto users = must(listUsers(store));
  const User nils = *std::ranges::find(users, "nils", &User::name);
  for (int i = 0; i < 4; ++i) {  // forgotten, and waited for
    std::ignore = signIn(store, "nils", "forgotten one");
  }
  must(signIn(store, "anna", kPassword));
  must(givePassword(store, nils.id, "a new password"));
  EXPECT_EQ(must(signIn(store, "nils", "a new password")).role, Role::Nurse);
  expectFails(givePassword(store, nils.id, "his own choice"), ErrorCode::NotPermitted);

  must(signIn(store, "anna", kPassword));
  const User out =
      must(changeUser(store, nils.id, must(findUser(store, nils.id)).revision, Role::Nurse, false));
  // Without a password there is nothing that could open the records.
  expectFails(changeUser(store, nils.id, out.revision, Role::Nurse, true),
              ErrorCode::StepNotAllowed);
  expectFails(givePassword(store, nils.id, "short"), ErrorCode::RecordInvalid);
  EXPECT_FALSE(must(findUser(store, nils.id)).active);
  EXPECT_TRUE(must(givePassword(store, nils.id, "and once more")).active);
  must(signIn(store, "nils", "and once more"));
}

TEST_P(SignIn, NamesAreUniqueAndRolesKeepTheirLimits) {
  Store store = openAs("anna");
  expectFails(addUser(store, "nils", Role::Nurse, kPassword), ErrorCode::RecordInvalid);
  expectFails(addUser(store, "new", Role::Nurse, "short"), ErrorCode::RecordInvalid);
  EXPECT_EQ(must(listUsers(store)).size(), 4U);  // the failed one left nothing behind
  expectFails(addPatient(store, named("Berg", "Ida")), ErrorCode::NotPermitted);
  must(signIn(store, "rita", kPassword));
  expectFails(addPatient(store, named("Berg", "Ida")), ErrorCode::NotPermitted);
  expectFails(addUser(store, "new", Role::Nurse, kPassword), ErrorCode::NotPermitted);
}

TEST_P(SignIn, SettingsAreKeptWithTheirRevision) {
  Store store = openAs("anna");
  StoreSettings settings = must(storeSettings(store));
  EXPECT_EQ(settings.revision, 0);
  settings.values["clinic"] = "Foot clinic";
  const StoreSettings saved = must(changeStoreSettings(store, settings));
  EXPECT_EQ(saved.values["clinic"], "Foot clinic");
  expectFails(changeStoreSettings(store, settings), ErrorCode::RecordStale);
}

}  // namespace
}  // namespace tarsus
