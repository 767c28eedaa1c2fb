#pragma once

#include "reconstruction/pipeline/reconstruct.h"

#include <chrono>

namespace tarsus {

/// Measures one stage after the other.
class StageClock {
 public:
  /// Ends the stage that ran until now.
  /// @param frames  how many it went through; 0: no frames
  void end(std::string name, int frames);
  [[nodiscard]] std::vector<StageTime> stages() const { return stages_; }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<StageTime> stages_;
};

}  // namespace tarsus
