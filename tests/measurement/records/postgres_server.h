#pragma once

#include "measurement/records/database.h"
#include "tests/support/temporary_folder.h"

#include <string>

namespace tarsus {

/// A PostgreSQL server of its own for one test program, on a unix socket in a temporary folder.
class PostgresServer {
 public:
  PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;
  ~PostgresServer();

  /// Started when it is first asked for.
  [[nodiscard]] static PostgresServer& instance();
  /// Why there is none; empty where it runs.
  [[nodiscard]] const std::string& missing() const { return missing_; }
  /// A fresh database in it.
  [[nodiscard]] PostgresAddress newDatabase();

 private:
  TemporaryFolder folder_;
  std::string programs_;
  std::string missing_;
  int databases_ = 0;
};

}  // namespace tarsus
