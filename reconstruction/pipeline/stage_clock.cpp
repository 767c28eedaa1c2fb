#include "reconstruction/pipeline/stage_clock.h"

namespace tarsus {

void StageClock::end(std::string name, int frames) {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  stages_.push_back({.name = std::move(name),
                     .seconds = seconds,
                     .frames_per_second = seconds > 0.0 ? frames / seconds : 0.0});
  start_ = now;
}

}  // namespace tarsus
