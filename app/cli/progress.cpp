#include "app/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace tarsus {

ProgressBar::ProgressBar(bool quiet) : on_(!quiet && ::isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(std::string_view stage, double fraction) {
  if (!on_) {
    return;
  }
  constexpr int kWidth = 30;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(fraction * kWidth);
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * fraction);
  std::string line = "[" + std::string(filled, '#') + std::string(kWidth - filled, ' ') + "] " +
                     percent + "  " + std::string(stage);
  if (line != shown_) {  // a terminal is slower than a frame
    std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
    std::fflush(stderr);
    shown_ = std::move(line);
  }
}

void ProgressBar::clear() {
  if (on_ && !shown_.empty()) {
    std::fprintf(stderr, "\r\x1b[K");
    std::fflush(stderr);
    shown_.clear();
  }
}

}  // namespace tarsus
