#pragma once

#include "reconstruction/fusion/depth_planes.h"

#include <algorithm>
#include <limits>

namespace tarsus {

/// Between which depths a frame can say something about a point, tile by tile: most blocks of a
/// volume are told by a glance here that a frame does not concern them. Private to fusion/.
class DepthTiles {
 public:
  /// @param band_mm  how far before and behind a plane the frame speaks, across the plane
  DepthTiles(const DepthPlanes& planes, float band_mm);

  /// Whether a ball [mm, camera frame] may hold a point that the frame speaks about.
  [[nodiscard]] bool mayConcern(const Eigen::Vector3f& center_camera, float radius_mm) const;

 private:
  static constexpr int kTile_px = 16;
  struct Range {
    float nearest_mm = std::numeric_limits<float>::infinity();
    float farthest_mm = -std::numeric_limits<float>::infinity();
  };

  Intrinsics intrinsics_;
  int columns_;
  int rows_;
  std::vector<Range> tiles_;
};

}  // namespace tarsus
