#pragma once

#include <string>
#include <string_view>

namespace tarsus {

/// A bar on stderr, where that is a terminal; silent otherwise.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  /// @param fraction  in [0, 1]
  void show(std::string_view stage, double fraction);
  void clear();

 private:
  bool on_ = false;
  std::string shown_;
};

}  // namespace tarsus
