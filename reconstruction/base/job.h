#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

namespace tarsus {

/// How a long stage hears "stop" and says how far it is. The core knows no thread and no window.
struct Job {
  std::stop_token stop;
  /// stage: short English name; fraction in [0, 1].
  std::function<void(std::string_view stage, double fraction)> report = [](auto, auto) {};

  [[nodiscard]] bool stopped() const { return stop.stop_requested(); }
};

}  // namespace tarsus
