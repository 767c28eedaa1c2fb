#pragma once

#include "reconstruction/scene/frame.h"

namespace tarsus {

/// Takes the lens distortion out of images of one camera, so that everything behind capture sees a
/// pinhole with the same fx, fy, cx, cy. Does nothing where the camera has none.
class Undistorter {
 public:
  explicit Undistorter(const Intrinsics& intrinsics);

  /// Nearest pixel: depths are never mixed over an edge.
  [[nodiscard]] DepthImage apply(DepthImage depth) const;
  /// Bilinear; black outside.
  [[nodiscard]] ColorImage apply(ColorImage color) const;

 private:
  Image<Eigen::Vector2f> source_px_;  ///< where each pixel comes from; empty: no distortion
};

}  // namespace tarsus
