#pragma once

#include "reconstruction/scene/image.h"

#include <Eigen/Geometry>

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace tarsus {

/// Rigid motion in mm. Named target_from_source: p_scan = scan_from_camera * p_camera.
using RigidTransform = Eigen::Isometry3d;

/// Pinhole camera; u to the right, v down, pixel centres at integers [px].
struct Intrinsics {
  int width = 0;
  int height = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3 as OpenCV; all 0 = none

  /// Direction through pixel (u, v) with z = 1, distortion ignored (frames leave capture
  /// undistorted).
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const {
    return {(u - cx_px) / fx_px, (v - cy_px) / fy_px, 1.0};
  }
  /// Pixel of a point before the camera (z > 0), distortion ignored.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    return {fx_px * p_camera.x() / p_camera.z() + cx_px,
            fy_px * p_camera.y() / p_camera.z() + cy_px};
  }
  bool operator==(const Intrinsics&) const = default;
};

/// Fixed properties of one camera, read once per scan and kept with the record.
struct RgbdCamera {
  Intrinsics depth;
  Intrinsics color;
  RigidTransform color_from_depth = RigidTransform::Identity();
  double depth_units_per_m = 1000.0;  ///< of the stored 16-bit depth: 8000 for 0.125 mm
  double frames_per_s = 30.0;
  std::string model;
  std::string serial;
};

/// One exposure, depth and colour taken together.
struct RgbdFrame {
  int index = 0;                          ///< position in the scan, broken frames counted
  std::chrono::microseconds timestamp{};  ///< of the depth image
  DepthImage depth;
  ColorImage color;  ///< empty where colour was not asked for
};

/// Where the depth camera was at one frame, and how far the tracker can be trusted there.
struct FramePose {
  int frame_index = 0;
  std::chrono::microseconds timestamp{};
  std::optional<RigidTransform> scan_from_camera;  ///< empty where tracking was lost
  double rmse_mm = 0.0;
  double inlier_fraction = 0.0;
};

using Trajectory = std::vector<FramePose>;

}  // namespace tarsus
