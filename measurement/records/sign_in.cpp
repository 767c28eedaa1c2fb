#include "measurement/records/sign_in.h"

#include "measurement/records/audit.h"
#include "measurement/records/revisions.h"
#include "measurement/records/users.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tarsus {
namespace {

constexpr const char* kRecoveryHolder = "recovery";

std::string userHolder(std::string_view name) { return "user:" + std::string(name); }

struct KeyRow {
  std::string user_id;
  WrappedKey wrapped;
  std::int64_t failures = 0;
  std::int64_t last_failure_ms = 0;
};

Expected<KeyRow> readKey(Store& store, const std::string& holder) {
  const auto rows = store.database().query(
      "SELECT user_record, salt, operations, memory_bytes, sealed, failures, last_failure_ms FROM "
      "key_wrap WHERE holder = ?",
      {holder});
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  if (rows->empty()) {
    return fail(ErrorCode::PasswordWrong);
  }
  const SqlRow& row = rows->front();
  return KeyRow{.user_id = row.text(0),
                .wrapped = {.salt = row.bytes(1),
                            .cost = {.operations = row.integer(2), .memory_bytes = row.integer(3)},
                            .sealed = row.bytes(4)},
                .failures = row.integer(5),
                .last_failure_ms = row.integer(6)};
}

Expected<void> writeKey(Store& store,
                        const std::string& holder,
                        const std::string& user_id,
                        const WrappedKey& wrapped) {
  auto removed = store.database().execute("DELETE FROM key_wrap WHERE holder = ?", {holder});
  if (!removed) {
    return tl::unexpected(removed.error());
  }
  auto written = store.database().execute(
      "INSERT INTO key_wrap (holder, user_record, salt, operations, memory_bytes, sealed, "
      "failures, "
      "last_failure_ms) VALUES (?, ?, ?, ?, ?, ?, 0, 0)",
      {holder,
       user_id,
       wrapped.salt,
       wrapped.cost.operations,
       wrapped.cost.memory_bytes,
       wrapped.sealed});
  return written ? Expected<void>() : tl::unexpected(written.error());
}

/// Waiting time before the next attempt.
std::int64_t delayMs(std::int64_t failures) {
  constexpr std::int64_t kFree = 3;
  constexpr std::int64_t kFirstMs = 4000;
  constexpr std::int64_t kLongestMs = std::int64_t{15} * 60 * 1000;
  constexpr std::int64_t kMostDoublings = 8;
  return failures < kFree
             ? 0
             : std::min(kLongestMs, kFirstMs << std::min(failures - kFree, kMostDoublings));
}

struct Opened {
  std::string user_id;
  std::int64_t failures;
  SecretKey store_key;
};

/// The attempt is counted before it is made, so that many at once gain nothing.
Expected<KeyRow> countAttempt(Store& store, const std::string& holder) {
  auto transaction = Transaction::begin(store.database());
  if (!transaction) {
    return tl::unexpected(transaction.error());
  }
  auto row = readKey(store, holder);
  if (!row) {
    return row;
  }
  const std::int64_t now_ms = store.environment().now_ms();
  const std::int64_t wait_ms = row->last_failure_ms + delayMs(row->failures) - now_ms;
  // A clock that was set back must not lock anybody out for longer than the delay itself.
  if (wait_ms > 0 && now_ms >= row->last_failure_ms) {
    return fail(ErrorCode::SignInDelayed,
                "wait " + std::to_string((wait_ms + 999) / 1000) + " s before the next attempt");
  }
  auto counted = store.database().execute(
      "UPDATE key_wrap SET failures = failures + 1, last_failure_ms = ? WHERE holder = ?",
      {now_ms, holder});
  if (!counted) {
    return tl::unexpected(counted.error());
  }
  if (auto done = transaction->commit(); !done) {
    return tl::unexpected(done.error());
  }
  return row;
}

Expected<Opened> openKey(Store& store, const std::string& holder, std::string_view password) {
  auto row = countAttempt(store, holder);
  if (!row) {
    return tl::unexpected(row.error());
  }
  auto store_key = unwrapKey(row->wrapped, password, holder);
  if (!store_key) {
    return tl::unexpected(store_key.error());
  }
  auto cleared = store.database().execute(
      "UPDATE key_wrap SET failures = 0, last_failure_ms = 0 WHERE holder = ?", {holder});
  if (!cleared) {
    return tl::unexpected(cleared.error());
  }
  return Opened{.user_id = std::move(row->user_id),
                .failures = row->failures,
                .store_key = std::move(*store_key)};
}

/// Reads, under the opened key, who this is; nobody stays signed in where that fails.
Expected<SignedIn> enter(Store& store, Opened opened, std::string_view name) {
  store.signedIn({.id = opened.user_id, .name = std::string(name)}, std::move(opened.store_key));
  const auto user = findUser(store, opened.user_id);
  // The name is compared because the row that names the record can be changed by anybody.
  if (!user || !user->active || user->name != name) {
    store.lock();
    return user || user.error().code == ErrorCode::RecordMissing ? fail(ErrorCode::PasswordWrong)
                                                                 : tl::unexpected(user.error());
  }
  const auto key = store.vault().storeKey();
  SecretKey copy;
  std::copy_n((*key)->data(), SecretKey::kSize, copy.data());
  SignedIn signed_in{.id = user->id, .name = user->name, .role = user->role};
  store.signedIn(signed_in, std::move(copy));
  return signed_in;
}

Expected<void> checkPassword(std::string_view password) {
  return password.size() >= kShortestPassword
             ? Expected<void>()
             : fail(ErrorCode::RecordInvalid, "a password needs at least 8 characters");
}

Expected<std::string> writeRecoveryCode(Store& store) {
  const auto key = store.vault().storeKey();
  if (!key) {
    return tl::unexpected(key.error());
  }
  std::string code = newRecoveryCode();
  const auto wrapped = wrapKey(**key, code, kRecoveryHolder, store.environment().key_cost);
  if (!wrapped) {
    return tl::unexpected(wrapped.error());
  }
  auto written = writeKey(store, kRecoveryHolder, {}, *wrapped);
  return written ? Expected<std::string>(std::move(code)) : tl::unexpected(written.error());
}

}  // namespace

Expected<bool> isNewStore(Store& store) {
  const auto rows = store.database().query("SELECT holder FROM key_wrap LIMIT 1");
  return rows ? Expected<bool>(rows->empty()) : tl::unexpected(rows.error());
}

Expected<std::string> firstRun(Store& store, std::string_view name, std::string_view password) {
  auto transaction = Transaction::begin(store.database());
  if (!transaction) {
    return tl::unexpected(transaction.error());
  }
  const auto is_new = isNewStore(store);
  if (!is_new || !*is_new) {
    return is_new ? fail(ErrorCode::StepNotAllowed, "these records have users already")
                  : tl::unexpected(is_new.error());
  }
  // The first user makes itself: nobody else could.
  const SignedIn first{.id = newId('U'), .name = std::string(name), .role = Role::Administrator};
  store.signedIn(first, SecretKey::random());
  Expected<std::string> code =
      addUser(store, name, Role::Administrator, password).and_then([&](const User&) {
        return writeRecoveryCode(store);
      });
  const auto done = code ? transaction->commit() : tl::unexpected(code.error());
  if (!done) {
    store.lock();
    return tl::unexpected(done.error());
  }
  std::ignore = writeAuditAnchor(store.database(), store.anchorFile(), AnchorStep::Begin);
  return code;
}

Expected<SignedIn> signIn(Store& store, std::string_view name, std::string_view password) {
  store.lock();
  auto opened = openKey(store, userHolder(name), password);
  if (!opened) {
    return tl::unexpected(opened.error());
  }
  const std::int64_t failures = opened->failures;
  auto user = enter(store, std::move(*opened), name);
  if (user) {
    auto noted =
        noteAct(store,
                Permission::Read,
                "sign in",
                failures > 0 ? "after " + std::to_string(failures) + " wrong attempts" : "");
    if (!noted) {
      store.lock();
      return tl::unexpected(noted.error());
    }
  }
  return user;
}

Expected<void> changePassword(Store& store,
                              std::string_view old_password,
                              std::string_view new_password) {
  const auto user = store.who(Permission::Read);
  if (!user) {
    return tl::unexpected(user.error());
  }
  if (auto usable = checkPassword(new_password); !usable) {
    return usable;
  }
  if (auto known = openKey(store, userHolder(user->name), old_password); !known) {
    return tl::unexpected(known.error());
  }
  auto change = StoreChange::begin(store, Permission::Read);
  if (!change) {
    return tl::unexpected(change.error());
  }
  return writeUserKey(store, user->name, user->id, new_password)
      .and_then([&] { return noteAct(store, Permission::Read, "change password"); })
      .and_then([&] { return change->commit(); });
}

Expected<SignedIn> resetPassword(Store& store,
                                 std::string_view name,
                                 std::string_view recovery_code,
                                 std::string_view new_password) {
  store.lock();
  const auto code = readRecoveryCode(recovery_code);
  if (!code) {
    return tl::unexpected(code.error());
  }
  if (auto usable = checkPassword(new_password); !usable) {
    return tl::unexpected(usable.error());
  }
  auto opened = openKey(store, kRecoveryHolder, *code);
  if (!opened) {
    return tl::unexpected(opened.error());
  }
  const auto row = readKey(store, userHolder(name));
  if (!row) {
    return tl::unexpected(row.error());
  }
  opened->user_id = row->user_id;
  auto user = enter(store, std::move(*opened), name);
  if (!user) {
    return user;
  }
  const auto reset = [&]() -> Expected<void> {
    auto change = StoreChange::begin(store, Permission::Read);
    if (!change) {
      return tl::unexpected(change.error());
    }
    return writeUserKey(store, user->name, user->id, new_password)
        .and_then(
            [&] { return noteAct(store, Permission::Read, "reset password by recovery code"); })
        .and_then([&] { return change->commit(); });
  }();
  if (!reset) {
    store.lock();
    return tl::unexpected(reset.error());
  }
  return user;
}

Expected<std::string> renewRecoveryCode(Store& store) {
  auto change = StoreChange::begin(store, Permission::ManageUsers);
  if (!change) {
    return tl::unexpected(change.error());
  }
  auto code = writeRecoveryCode(store);
  if (!code) {
    return code;
  }
  const auto done = noteAct(store, Permission::ManageUsers, "renew recovery code").and_then([&] {
    return change->commit();
  });
  return done ? std::move(code) : tl::unexpected(done.error());
}

Expected<void> writeUserKey(Store& store,
                            std::string_view name,
                            std::string_view user_id,
                            std::string_view password) {
  const auto key = store.vault().storeKey();
  if (!key) {
    return tl::unexpected(key.error());
  }
  if (auto usable = checkPassword(password); !usable) {
    return usable;
  }
  const std::string holder = userHolder(name);
  const auto wrapped = wrapKey(**key, password, holder, store.environment().key_cost);
  return wrapped ? writeKey(store, holder, std::string(user_id), *wrapped)
                 : tl::unexpected(wrapped.error());
}

Expected<void> removeUserKey(Store& store, std::string_view name) {
  auto removed =
      store.database().execute("DELETE FROM key_wrap WHERE holder = ?", {userHolder(name)});
  return removed ? Expected<void>() : tl::unexpected(removed.error());
}

}  // namespace tarsus
