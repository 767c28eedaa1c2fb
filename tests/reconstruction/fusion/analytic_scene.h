#pragma once

#include "reconstruction/capture/frame_source.h"

#include <functional>
#include <vector>

namespace tarsus {

struct Sphere {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

/// Points x with normal . x = offset; seen from either side.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_mm = 0.0;
};

/// Surfaces with closed-form rays, so that depth images and distances are exact.
struct AnalyticScene {
  std::vector<Sphere> spheres;
  std::vector<Plane> planes;

  /// Distance of p from the nearest surface [mm].
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  /// Depth image without noise; 0 where a ray hits nothing within 2 m.
  [[nodiscard]] DepthImage render(const Intrinsics& camera,
                                  const RigidTransform& scan_from_camera) const;
};

/// Bumps of different size before a tilted wall: holds a camera in all six directions.
[[nodiscard]] AnalyticScene bumpyScene();

/// 320 x 240 pixels with the field of view of an SR300.
[[nodiscard]] RgbdCamera smallCamera();

/// Coded-light noise: sigma_z = (0.15 + 0.6 z[m]) mm, independent from pixel to pixel, 0.125 mm
/// steps; the same for the same seed everywhere.
[[nodiscard]] DepthImage withNoise(const DepthImage& depth, std::uint64_t seed);

/// Camera on an arc: turned by `angle_rad` about the axis that runs along y through (0, 0, 400).
[[nodiscard]] RigidTransform arcPose(double angle_rad);

/// Frames from memory.
class FrameList : public FrameSource {
 public:
  FrameList(const RgbdCamera& camera, std::vector<RgbdFrame> frames)
      : camera_(camera), frames_(std::move(frames)) {}
  [[nodiscard]] const RgbdCamera& camera() const override { return camera_; }
  [[nodiscard]] std::optional<int> frameCount() const override {
    return static_cast<int>(frames_.size());
  }
  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    return next_ < frames_.size() ? std::optional(frames_[next_++]) : std::nullopt;
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

 private:
  RgbdCamera camera_;
  std::vector<RgbdFrame> frames_;
  std::size_t next_ = 0;
  Warnings warnings_;
};

/// @param index  also gives the time, 30 frames a second
[[nodiscard]] RgbdFrame frameOf(DepthImage depth, int index);

}  // namespace tarsus
