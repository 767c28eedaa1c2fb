#include "reconstruction/capture/trajectory_file.h"

#include "reconstruction/base/atomic_file.h"

#include <cmath>
#include <cstdio>
#include <sstream>

namespace tarsus {
namespace {

constexpr double kMmPerM = 1000.0;

Expected<FramePose> parsePose(const std::string& line, int number) {
  std::istringstream words(line);
  double t_s = 0.0;
  Eigen::Vector3d p_m;
  Eigen::Quaterniond q;
  words >> t_s >> p_m.x() >> p_m.y() >> p_m.z() >> q.x() >> q.y() >> q.z() >> q.w();
  const bool finite = std::isfinite(t_s) && p_m.allFinite() && q.coeffs().allFinite();
  if (words.fail() || !finite || std::abs(q.norm() - 1.0) > 0.01 || std::abs(t_s) > 1e11) {
    return fail(ErrorCode::TrajectoryInvalid, "line " + std::to_string(number) + ": " + line);
  }
  FramePose pose;
  pose.timestamp = std::chrono::microseconds(std::llround(t_s * 1e6));
  pose.scan_from_camera = RigidTransform::Identity();
  pose.scan_from_camera->linear() = q.normalized().toRotationMatrix();
  pose.scan_from_camera->translation() = p_m * kMmPerM;
  return pose;
}

}  // namespace

Expected<Trajectory> readTrajectory(const std::filesystem::path& path) {
  auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  Trajectory trajectory;
  std::istringstream lines(*text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') {
      continue;
    }
    auto pose = parsePose(line, number);
    if (!pose) {
      return tl::unexpected(pose.error());
    }
    pose->frame_index = static_cast<int>(trajectory.size());
    trajectory.push_back(*pose);
  }
  if (trajectory.empty()) {
    return fail(ErrorCode::TrajectoryInvalid, path.string() + " holds no pose");
  }
  return trajectory;
}

Expected<void> writeTrajectory(const std::filesystem::path& path, const Trajectory& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw (metres, scan_from_camera)\n";
  for (const FramePose& pose : trajectory) {
    if (!pose.scan_from_camera) {
      continue;
    }
    const Eigen::Vector3d p_m = pose.scan_from_camera->translation() / kMmPerM;
    const Eigen::Quaterniond q(pose.scan_from_camera->linear());
    char line[256];
    std::snprintf(line,
                  sizeof line,
                  "%.6f %.9f %.9f %.9f %.10f %.10f %.10f %.10f\n",
                  static_cast<double>(pose.timestamp.count()) * 1e-6,
                  p_m.x(),
                  p_m.y(),
                  p_m.z(),
                  q.x(),
                  q.y(),
                  q.z(),
                  q.w());
    text += line;
  }
  return writeTextAtomically(path, text);
}

std::optional<RigidTransform> poseAt(const Trajectory& trajectory,
                                     std::chrono::microseconds timestamp,
                                     std::chrono::microseconds tolerance) {
  std::optional<RigidTransform> best;
  for (const FramePose& pose : trajectory) {
    const auto difference = std::chrono::abs(pose.timestamp - timestamp);
    if (pose.scan_from_camera && difference <= tolerance) {
      tolerance = difference;
      best = pose.scan_from_camera;
    }
  }
  return best;
}

}  // namespace tarsus
