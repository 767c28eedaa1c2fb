#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tarsus {

/// Wall and processor time since it was made; the processor time is that of all threads.
class StopWatch {
 public:
  [[nodiscard]] double wall_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }
  [[nodiscard]] double cpu_s() const {
    return static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC;
  }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  std::clock_t cpu_ = std::clock();
};

/// The value, or the program ends with the error's sentence.
template <typename T>
T orExit(Expected<T> value) {
  if (!value) {
    std::fprintf(stderr, "tarsus-bench: %s\n", describe(value.error()).c_str());
    std::exit(1);
  }
  if constexpr (!std::is_void_v<T>) {
    return std::move(*value);
  }
}

/// Distances as a table line: root mean square and what stands behind it.
struct Distances {
  std::vector<double> values_mm;

  /// Line "name RMS mean 95 % farthest".
  void print(const char* name) const;
  /// The same over the values up to a limit, with the share beyond.
  void printWithin(const char* name, double limit_mm) const;
};

/// Camera positions against the reference, first tracked pose anchored, no further alignment
/// (design.md section 5).
struct TrajectoryError {
  double rms_mm = 0.0;
  double farthest_mm = 0.0;
  double turn_rad = 0.0;  ///< largest
  int poses = 0;
};
[[nodiscard]] TrajectoryError trajectoryError(const Trajectory& trajectory,
                                              const Trajectory& reference);
void printTrajectoryError(const Trajectory& trajectory, const Trajectory& reference);

/// Lost frames, one line each.
void printLostFrames(const Trajectory& trajectory);

/// Largest memory of this program so far.
[[nodiscard]] double peakMemory_mb();

/// What the command line gives.
struct BenchArguments {
  std::string input;               ///< a scan folder
  std::filesystem::path pictures;  ///< empty: none
  double voxel_size_mm = 1.0;
};

}  // namespace tarsus
