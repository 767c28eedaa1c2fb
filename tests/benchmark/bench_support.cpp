#include "tests/benchmark/bench_support.h"

#include "reconstruction/capture/trajectory_file.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tarsus {

void Distances::print(const char* name) const {
  std::vector<double> sorted = values_mm;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0.0;
  double squares = 0.0;
  for (const double d : sorted) {
    sum += std::abs(d);
    squares += d * d;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(1, sorted.size()));
  const auto at = [&](double share) {
    return sorted.empty() ? 0.0 : sorted[static_cast<std::size_t>(share * (n - 1.0))];
  };
  std::printf("%-27s %8.3f   mean %.3f, median %.3f, 95 %% %.3f, farthest %.2f, %zu points\n",
              name,
              std::sqrt(squares / n),
              sum / n,
              at(0.5),
              at(0.95),
              at(1.0),
              sorted.size());
}

void Distances::printWithin(const char* name, double limit_mm) const {
  Distances near;
  for (const double d : values_mm) {
    if (d <= limit_mm) {
      near.values_mm.push_back(d);
    }
  }
  near.print(name);
  const auto n = static_cast<double>(std::max<std::size_t>(1, values_mm.size()));
  std::printf("  beyond %.0f mm, left out     %8.3f %%\n",
              limit_mm,
              100.0 * (1.0 - static_cast<double>(near.values_mm.size()) / n));
}

TrajectoryError trajectoryError(const Trajectory& trajectory, const Trajectory& reference) {
  constexpr std::chrono::microseconds kSameTime{2000};
  std::optional<RigidTransform> scan_from_reference;
  TrajectoryError error;
  double squares = 0.0;
  for (const FramePose& pose : trajectory) {
    const auto truth = poseAt(reference, pose.timestamp, kSameTime);
    if (!pose.scan_from_camera || !truth) {
      continue;
    }
    if (!scan_from_reference) {
      scan_from_reference = *pose.scan_from_camera * truth->inverse();
    }
    const RigidTransform difference =
        pose.scan_from_camera->inverse() * *scan_from_reference * *truth;
    const double distance = difference.translation().norm();
    squares += distance * distance;
    error.farthest_mm = std::max(error.farthest_mm, distance);
    error.turn_rad = std::max(error.turn_rad, Eigen::AngleAxisd(difference.linear()).angle());
    ++error.poses;
  }
  error.rms_mm = std::sqrt(squares / std::max(1, error.poses));
  return error;
}

void printTrajectoryError(const Trajectory& trajectory, const Trajectory& reference) {
  const TrajectoryError error = trajectoryError(trajectory, reference);
  std::printf("trajectory RMSE [mm]        %8.3f   farthest %.2f mm, %.3f degrees, %d poses\n",
              error.rms_mm,
              error.farthest_mm,
              error.turn_rad * 180.0 / 3.14159265358979,
              error.poses);
}

void printLostFrames(const Trajectory& trajectory) {
  for (const FramePose& pose : trajectory) {
    if (!pose.scan_from_camera) {
      std::printf("  lost: frame %d, residual %.2f mm, inliers %.2f\n",
                  pose.frame_index,
                  pose.rmse_mm,
                  pose.inlier_fraction);
    }
  }
}

double peakMemory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace tarsus
