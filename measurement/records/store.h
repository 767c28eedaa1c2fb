#pragma once

#include "measurement/records/database.h"
#include "measurement/records/file_store.h"
#include "measurement/records/key_wrap.h"
#include "measurement/records/name_index.h"
#include "measurement/records/roles.h"
#include "measurement/records/vault.h"
#include "reconstruction/base/error.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tarsus {

/// Where the records lie. The folder holds files/ and audit.anchor, and records.sqlite unless a
/// server keeps the tables.
struct StorePlace {
  std::filesystem::path folder;
  std::optional<PostgresAddress> postgres;
};

/// What the store is told about the world around it.
struct StoreEnvironment {
  ClockMs now_ms;
  std::string station;  ///< this computer's name in the audit trail
  std::optional<std::int64_t> idle_ms = std::int64_t{10} * 60 * 1000;  ///< none: never locks
  KeyCost key_cost;
};

struct SignedIn {
  std::string id;
  std::string name;
  Role role = Role::ReadOnly;
};

/// The open records; used by one thread. What can be done with them stands in the headers of each
/// subject (patients.h, visits.h, ...) and of sign_in.h.
class Store {
 public:
  /// Opens the records, making an empty store where there is none.
  /// @errors FileUnwritable, DiskFull, StoreBusy, StoreFailed, StoreDamaged, StoreNewer
  [[nodiscard]] static Expected<Store> open(const StorePlace& place, StoreEnvironment environment);

  [[nodiscard]] Database& database() { return database_; }
  [[nodiscard]] Vault& vault() { return vault_; }
  [[nodiscard]] FileStore& files() { return files_; }
  [[nodiscard]] NameIndex& nameIndex() { return names_; }
  [[nodiscard]] const StoreEnvironment& environment() const { return environment_; }
  [[nodiscard]] std::filesystem::path anchorFile() const { return folder_ / "audit.anchor"; }

  /// Takes the place of whoever was signed in.
  void signedIn(SignedIn user, SecretKey store_key);
  /// Forgets the keys and the names.
  void lock();
  /// The one who is signed in, if the role allows this.
  /// @errors StoreLocked, NotPermitted
  [[nodiscard]] Expected<SignedIn> who(Permission permission);

 private:
  Store(std::filesystem::path folder, Database database, StoreEnvironment environment);
  std::filesystem::path folder_;
  StoreEnvironment environment_;
  Database database_;
  Vault vault_;
  FileStore files_;
  NameIndex names_;
  std::optional<SignedIn> user_;
};

/// One change of the records: all of it, with its audit entries, or nothing. Changes inside a
/// change join it.
class StoreChange {
 public:
  /// Looks up anew what the user may do, so that a role that was taken away is gone at once.
  /// @errors StoreLocked, NotPermitted, and those of Database
  [[nodiscard]] static Expected<StoreChange> begin(Store& store, Permission permission);
  [[nodiscard]] const SignedIn& who() const { return who_; }
  [[nodiscard]] Expected<void> commit();

 private:
  StoreChange(Store& store, SignedIn who, Transaction transaction)
      : store_(&store), who_(std::move(who)), transaction_(std::move(transaction)) {}
  Store* store_;
  SignedIn who_;
  Transaction transaction_;
};

/// An act that changes no record, as an export, in the audit trail: a change of its own.
/// @errors NotPermitted, and those of StoreChange
[[nodiscard]] Expected<void> noteAct(Store& store,
                                     Permission permission,
                                     std::string action,
                                     std::string details = {});

}  // namespace tarsus
