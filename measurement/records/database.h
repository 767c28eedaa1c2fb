#pragma once

#include "reconstruction/base/error.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tarsus {

using Bytes = std::vector<unsigned char>;
using SqlValue = std::variant<std::int64_t, std::string, Bytes>;

/// One row of a result; asking for another type than the column holds gives an empty value, so
/// that a damaged table is found by the seals and not by a crash.
class SqlRow {
 public:
  explicit SqlRow(std::vector<SqlValue> values) : values_(std::move(values)) {}
  [[nodiscard]] std::int64_t integer(std::size_t column) const;
  [[nodiscard]] std::string text(std::size_t column) const;
  [[nodiscard]] Bytes bytes(std::size_t column) const;
  [[nodiscard]] const std::vector<SqlValue>& values() const { return values_; }

 private:
  std::vector<SqlValue> values_;
};

/// A server as it is named in the settings; empty fields are left to the server's client.
struct PostgresAddress {
  std::string host;  ///< name, or the folder of a unix socket
  int port = 0;
  std::string database;
  std::string user;
  std::string password;
};

/// One connection to the records, SQLite or PostgreSQL, with the same SQL ("?" for values).
/// Belongs to the thread that opened it; the program must hold a QCoreApplication.
class Database {
 public:
  enum class Engine { Sqlite, Postgres };

  /// Makes the file where there is none. WAL, flushed at every commit, 10 s of patience.
  /// @errors FileUnwritable, DiskFull, StoreBusy, StoreDamaged, StoreFailed
  [[nodiscard]] static Expected<Database> openSqlite(const std::filesystem::path& file);
  /// @errors StoreFailed
  [[nodiscard]] static Expected<Database> openPostgres(const PostgresAddress& address);
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  [[nodiscard]] Engine engine() const;
  /// @errors as openSqlite; DiskFull and FileUnwritable leave everything as it was
  [[nodiscard]] Expected<std::vector<SqlRow>> query(std::string_view sql,
                                                    const std::vector<SqlValue>& values = {});
  /// @return rows changed
  Expected<std::int64_t> execute(std::string_view sql, const std::vector<SqlValue>& values = {});

 private:
  friend class Transaction;
  struct Impl;
  explicit Database(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// All or nothing; rolled back unless committed. Writers come one after the other, on both
/// engines, so that what is read inside still holds when it is written. One begun inside another
/// joins it; if the inner one is not committed, the outer one cannot be.
class Transaction {
 public:
  [[nodiscard]] static Expected<Transaction> begin(Database& database);
  /// For reading one moment's state while others go on writing; write nothing in it.
  [[nodiscard]] static Expected<Transaction> beginSnapshot(Database& database);
  Transaction(Transaction&& other) noexcept;
  Transaction& operator=(Transaction&&) = delete;
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  [[nodiscard]] Expected<void> commit();
  [[nodiscard]] bool isOutermost() const { return outermost_; }

 private:
  Transaction(Database::Impl& database, bool outermost)
      : database_(&database), outermost_(outermost) {}
  Database::Impl* database_;
  bool outermost_;
};

}  // namespace tarsus
