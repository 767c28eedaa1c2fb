#include "tests/reconstruction/fusion/perturbed_scan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace tarsus {
namespace {

const Eigen::Vector3d kMiddle(0.0, 0.0, 400.0);

/// In [-1, 1], the same everywhere.
double roll(std::mt19937& dice) { return static_cast<double>(dice()) * 0x1.0p-31 - 1.0; }

/// In the unit ball.
Eigen::Vector3d rollInBall(std::mt19937& dice) {
  while (true) {
    const double x = roll(dice);
    const double y = roll(dice);
    const Eigen::Vector3d p(x, y, roll(dice));
    if (p.norm() <= 1.0) {
      return p;
    }
  }
}

}  // namespace

std::vector<RigidTransform> arcPoses(int count, double step_rad) {
  std::vector<RigidTransform> poses;
  for (int i = 0; i < count; ++i) {
    poses.push_back(arcPose(step_rad * i));
  }
  return poses;
}

std::vector<RigidTransform> posesAllAround(double distance_mm) {
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d direction(i % 3 - 1, (i / 3) % 3 - 1, i / 9 - 1);
    if (direction.norm() > 0.0) {
      const Eigen::Vector3d forward = -direction.normalized();
      const Eigen::Vector3d hint =
          std::abs(forward.y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
      const Eigen::Vector3d right = hint.cross(forward).normalized();
      RigidTransform pose = RigidTransform::Identity();
      pose.linear() << right, forward.cross(right), forward;
      pose.translation() = kMiddle - forward * distance_mm;
      poses.push_back(pose);
    }
  }
  return poses;
}

Trajectory trajectoryOf(const std::vector<RigidTransform>& poses) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    FramePose pose;
    pose.frame_index = static_cast<int>(i);
    pose.timestamp = frameOf({}, static_cast<int>(i)).timestamp;
    pose.scan_from_camera = poses[i];
    trajectory.push_back(pose);
  }
  return trajectory;
}

std::vector<RigidTransform> perturbed(const std::vector<RigidTransform>& poses,
                                      double most_mm,
                                      double most_deg) {
  std::mt19937 dice(17);
  std::vector<RigidTransform> moved = poses;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Vector3d shift = most_mm * rollInBall(dice);
    const Eigen::Vector3d turn = (most_deg * std::numbers::pi / 180.0) * rollInBall(dice);
    moved[i] = Eigen::Translation3d(kMiddle + shift) *
               Eigen::AngleAxisd(turn.norm(), turn.normalized()) * Eigen::Translation3d(-kMiddle) *
               poses[i];
  }
  return moved;
}

std::vector<RgbdFrame> framesOf(const AnalyticScene& scene,
                                const std::vector<RigidTransform>& poses,
                                Depth depth) {
  std::vector<RgbdFrame> frames;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    DepthImage image = scene.render(smallCamera().depth, poses[i]);
    frames.push_back(frameOf(depth == Depth::Noisy ? withNoise(image, i + 1) : std::move(image),
                             static_cast<int>(i)));
  }
  return frames;
}

ScanArchive archiveOf(const std::vector<RgbdFrame>& frames) {
  ScanArchive archive(smallCamera(), static_cast<int>(frames.size()));
  for (const RgbdFrame& frame : frames) {
    archive.add(frame);
  }
  return archive;
}

double poseError(const RigidTransform& a, const RigidTransform& b) {
  // Both are scan_from_camera: what the camera sees at these places, where do they put it?
  const RigidTransform between = a * b.inverse();
  double largest = 0.0;
  for (int i = -1; i < 6; ++i) {
    Eigen::Vector3d p = kMiddle;
    if (i >= 0) {
      p[i / 2] += i % 2 == 0 ? 100.0 : -100.0;
    }
    largest = std::max(largest, (between * p - p).norm());
  }
  return largest;
}

}  // namespace tarsus
