#pragma once

#include "reconstruction/scene/frame.h"

#include <vector>

namespace tarsus {

/// A depth image made ready for fusion: one tangent plane for each pixel that can be trusted,
///   n . x + offset = distance of x before the surface [mm], camera frame, n towards the camera.
/// Pixels at depth discontinuities, where flying pixels live, and at grazing incidence have none.
/// All arrays are row-major and end with one extra entry without a plane, for points outside the
/// image.
struct DepthPlanes {
  /// Offset where there is no plane: farther off than any band reaches.
  static constexpr float kNoPlane_mm = 1e9F;

  Intrinsics intrinsics;
  std::vector<float> nx, ny, nz, offset_mm;
  std::vector<float> quality;   ///< cosine of the angle of incidence; 0 where there is no plane
  std::vector<float> depth_mm;  ///< z of the pixels with a plane; 0 elsewhere
  int valid_count = 0;

  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(intrinsics.width) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] Eigen::Vector3f normal(std::size_t pixel) const {
    return {nx[pixel], ny[pixel], nz[pixel]};
  }
};

struct DepthPlaneOptions {
  double min_depth_mm = 100.0;
  double max_depth_mm = 1500.0;
  /// Farther than this times the nearest tenth of the frame: background, noisy and large, that
  /// holds neither pose nor measure. 0: no such limit. Ours.
  double max_depth_ratio = 2.0;
  double max_incidence_deg = 75.0;  ///< beyond, a coded-light camera returns little but errors
};

/// Fits the planes over 5 x 5 pixels: least squares on 1/z, which is linear in the pixel on a
/// plane, from pairs of opposite neighbours that continue the surface through the middle pixel.
/// Gaps one pixel wide are bridged first where both sides belong to one surface.
[[nodiscard]] DepthPlanes fitDepthPlanes(const Intrinsics& intrinsics,
                                         const DepthImage& depth,
                                         const DepthPlaneOptions& options);

}  // namespace tarsus
