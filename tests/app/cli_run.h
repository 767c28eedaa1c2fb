#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace tarsus {

struct CliRun {
  int exit_code = -1;
  std::string output;  ///< stdout and stderr
};

inline CliRun runShell(const std::string& command) {
  CliRun run;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    run.output.append(buffer.data(), n);
  }
  const int status = ::pclose(pipe);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return run;
}

inline CliRun cli(const std::string& arguments) {
  return runShell(std::string(TARSUS_CLI) + " " + arguments);
}

}  // namespace tarsus
