#pragma once

#include "reconstruction/scene/frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace tarsus {

/// What one frame measured where a vertex should be.
struct VertexReading {
  float height_mm;  ///< of the measured surface over the vertex, along its normal
  float depth_mm;
  float cosine;  ///< of the angle of incidence
};

/// Reads a depth image at the vertices of a surface. Private to fusion/.
class VertexView {
 public:
  VertexView(const Intrinsics& k,
             const DepthImage& depth,
             const RigidTransform& scan_from_camera,
             double max_view_angle_deg)
      : depth_(&depth),
        camera_from_scan_(scan_from_camera.inverse().cast<float>()),
        fx_(static_cast<float>(k.fx_px)),
        fy_(static_cast<float>(k.fy_px)),
        cx_(static_cast<float>(k.cx_px)),
        cy_(static_cast<float>(k.cy_px)),
        last_u_(static_cast<float>(k.width - 1)),
        last_v_(static_cast<float>(k.height - 1)),
        min_cosine_(static_cast<float>(std::cos(max_view_angle_deg * std::numbers::pi / 180.0))) {}

  /// @return nothing where the vertex is out of view or oblique, or where no depth is
  [[nodiscard]] std::optional<VertexReading> read(const Eigen::Vector3f& vertex,
                                                  const Eigen::Vector3f& normal) const {
    const Eigen::Vector3f n = camera_from_scan_.linear() * normal;
    const Eigen::Vector3f p = camera_from_scan_ * vertex;
    const float along = n.dot(p);
    if (along >= 0.0F || p.z() <= 1.0F ||
        along * along < min_cosine_ * min_cosine_ * p.squaredNorm()) {
      return std::nullopt;
    }
    const float u = fx_ * p.x() / p.z() + cx_;
    const float v = fy_ * p.y() / p.z() + cy_;
    if (!(u >= 0.0F && v >= 0.0F && u < last_u_ && v < last_v_)) {
      return std::nullopt;
    }
    const float z = depthBetween(u, v);
    if (z <= 0.0F) {
      return std::nullopt;
    }
    return VertexReading{
        .height_mm = (z - p.z()) * along / p.z(), .depth_mm = z, .cosine = -along / p.norm()};
  }

 private:
  /// Depths around a pixel corner differ by no more than this on a surface seen at 75 degrees,
  /// with room for noise; beyond, it is an edge.
  static constexpr float kEdgeBase_mm = 2.0F;
  static constexpr float kEdgePerDepth = 0.009F;

  /// Depth between four pixel centres; 0 at edges and where one is missing.
  [[nodiscard]] float depthBetween(float u, float v) const {
    const int column = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const float* const upper = &depth_->at(column, row);
    const float* const lower = upper + depth_->width();
    const float nearest = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
    const float farthest = std::max(std::max(upper[0], upper[1]), std::max(lower[0], lower[1]));
    if (nearest <= 0.0F || farthest - nearest > kEdgeBase_mm + kEdgePerDepth * nearest) {
      return 0.0F;
    }
    const float tu = u - static_cast<float>(column);
    const float tv = v - static_cast<float>(row);
    const float top = upper[0] + tu * (upper[1] - upper[0]);
    const float bottom = lower[0] + tu * (lower[1] - lower[0]);
    return top + tv * (bottom - top);
  }

  const DepthImage* depth_;
  Eigen::Isometry3f camera_from_scan_;
  float fx_, fy_, cx_, cy_, last_u_, last_v_, min_cosine_;
};

}  // namespace tarsus
