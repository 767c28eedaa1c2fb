#include "tests/measurement/records/postgres_server.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

/// The newest one installed; Debian keeps the server's programs out of the path.
std::string findPrograms() {
  std::string newest;
  std::error_code error;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql", error)) {
    const std::string programs = version.path() / "bin";
    if (fs::exists(fs::path(programs) / "initdb", error) && programs > newest) {
      newest = programs;
    }
  }
  return newest;
}

/// The server refuses to run as root.
std::string asNobody(const std::string& command) {
  return ::geteuid() == 0 ? "runuser -u nobody -- " + command : command;
}

bool run(const std::string& command, const fs::path& log) {
  return std::system((command + " >>" + (log / "log").string() + " 2>&1 </dev/null").c_str()) == 0;
}

}  // namespace

PostgresServer::PostgresServer() : programs_(findPrograms()) {
  if (programs_.empty()) {
    missing_ = "no PostgreSQL server is installed (package postgresql)";
    return;
  }
  const std::string data = folder_.path() / "data";
  fs::permissions(folder_.path(), fs::perms::all);
  const bool made =
      run(asNobody(programs_ + "/initdb -A trust -U tarsus -E UTF8 --locale=C -D " + data),
          folder_.path()) &&
      run(asNobody(programs_ + "/pg_ctl -w -D " + data + " -o \"-k " + folder_.path().string() +
                   " -c fsync=off -c listen_addresses=''\" -l " + data + "/server.log start"),
          folder_.path());
  if (!made) {
    missing_ = "the PostgreSQL server does not start; its log is in " + folder_.path().string();
  }
}

PostgresServer::~PostgresServer() {
  if (missing_.empty()) {
    run(asNobody(programs_ + "/pg_ctl -m immediate -D " + (folder_.path() / "data").string() +
                 " stop"),
        folder_.path());
  }
}

PostgresServer& PostgresServer::instance() {
  static PostgresServer server;
  return server;
}

PostgresAddress PostgresServer::newDatabase() {
  const std::string name = "records_" + std::to_string(++databases_);
  run(programs_ + "/createdb -U tarsus -h " + folder_.path().string() + " " + name, folder_.path());
  return {.host = folder_.path(), .database = name, .user = "tarsus"};
}

}  // namespace tarsus
