#include "measurement/records/store.h"

#include "measurement/records/audit.h"
#include "measurement/records/migrations.h"
#include "measurement/records/users.h"
#include "reconstruction/base/require.h"

#include <system_error>
#include <tuple>
#include <utility>

namespace tarsus {

namespace {

/// New tables beside the files of earlier records: what held them was emptied, and new ones would
/// cover that up.
Expected<void> refuseEmptied(const StorePlace& place, Database& database) {
  std::error_code error;
  if (!std::filesystem::exists(place.folder / "audit.anchor", error)) {
    return {};
  }
  const auto version = tablesVersion(database);
  if (!version) {
    return tl::unexpected(version.error());
  }
  return *version > 0
             ? Expected<void>()
             : fail(ErrorCode::StoreDamaged,
                    "the tables are empty, but files of earlier records lie beside them in " +
                        place.folder.string() +
                        "; restore a backup into a new folder, and keep this one as it is");
}

}  // namespace

Store::Store(std::filesystem::path folder, Database database, StoreEnvironment environment)
    : folder_(std::move(folder)),
      environment_(std::move(environment)),
      database_(std::move(database)),
      vault_(environment_.now_ms, environment_.idle_ms),
      files_(folder_ / "files") {}

Expected<Store> Store::open(const StorePlace& place, StoreEnvironment environment) {
  TARSUS_REQUIRE(environment.now_ms != nullptr, "the store is given a clock");
  std::error_code error;
  std::filesystem::create_directories(place.folder, error);
  if (error) {
    return fail(ErrorCode::FileUnwritable, place.folder.string() + ": " + error.message());
  }
  auto database = place.postgres ? Database::openPostgres(*place.postgres)
                                 : Database::openSqlite(place.folder / "records.sqlite");
  if (!database) {
    return tl::unexpected(database.error());
  }
  if (auto whole = refuseEmptied(place, *database); !whole) {
    return tl::unexpected(whole.error());
  }
  if (auto migrated = migrate(*database); !migrated) {
    return tl::unexpected(migrated.error());
  }
  return Store(place.folder, std::move(*database), std::move(environment));
}

void Store::signedIn(SignedIn user, SecretKey store_key) {
  lock();
  vault_.unlock(std::move(store_key));
  user_ = std::move(user);
}

void Store::lock() {
  vault_.lock();
  names_.clear();
  user_.reset();
}

Expected<SignedIn> Store::who(Permission permission) {
  if (!user_ || vault_.isLocked()) {
    lock();  // also the names of a vault that locked itself
    return fail(ErrorCode::StoreLocked);
  }
  if (!isAllowed(user_->role, permission)) {
    return fail(ErrorCode::NotPermitted,
                "as " + std::string(nameOf(user_->role)) + " you may not " +
                    std::string(nameOf(permission)));
  }
  return *user_;
}

Expected<StoreChange> StoreChange::begin(Store& store, Permission permission) {
  auto who = store.who(permission);
  if (!who) {
    return tl::unexpected(who.error());
  }
  auto transaction = Transaction::begin(store.database());
  if (!transaction) {
    return tl::unexpected(transaction.error());
  }
  if (transaction->isOutermost()) {
    const auto user = findUser(store, who->id);
    const bool same = user && user->active && user->role == who->role;
    if (!same && (user || user.error().code == ErrorCode::RecordMissing)) {
      store.lock();
      return fail(ErrorCode::StoreLocked, "the administrator has changed what you may do");
    }
    if (!same) {
      return tl::unexpected(user.error());
    }
  }
  return StoreChange(store, std::move(*who), std::move(*transaction));
}

Expected<void> StoreChange::commit() {
  const bool outermost = transaction_.isOutermost();
  auto done = transaction_.commit();
  if (done && outermost) {
    // The change is safe already; an anchor left behind is reported by verifyAudit.
    std::ignore = writeAuditAnchor(store_->database(), store_->anchorFile());
  }
  return done;
}

Expected<void> noteAct(Store& store,
                       Permission permission,
                       std::string action,
                       std::string details) {
  auto change = StoreChange::begin(store, permission);
  if (!change) {
    return tl::unexpected(change.error());
  }
  auto entry = appendAudit(store.database(),
                           store.vault(),
                           {.at_ms = store.environment().now_ms(),
                            .who = change->who().id,
                            .station = store.environment().station,
                            .action = std::move(action),
                            .details = std::move(details)});
  return entry ? change->commit() : tl::unexpected(entry.error());
}

}  // namespace tarsus
