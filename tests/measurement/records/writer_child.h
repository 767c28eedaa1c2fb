#pragma once

#include "measurement/records/store.h"

#include <sys/types.h>

#include <string>
#include <vector>

namespace tarsus {

/// A child process of this program that writes visits until it is killed.
class WriterChild {
 public:
  /// @param wound  where the visits go; each confirmed one is a line "ID TEXT" on the child's pipe
  WriterChild(const StorePlace& place, const std::string& wound);
  WriterChild(const WriterChild&) = delete;
  WriterChild& operator=(const WriterChild&) = delete;
  ~WriterChild();

  /// Waits for the first confirmation, then for `wait_us` more, kills the child and returns all
  /// whole lines of its pipe.
  [[nodiscard]] std::vector<std::string> killAfter(unsigned wait_us);

 private:
  pid_t child_ = -1;
  int pipe_ = -1;
};

}  // namespace tarsus
