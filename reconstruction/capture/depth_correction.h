#pragma once

#include "reconstruction/scene/frame.h"

#include <array>

namespace tarsus {

/// What turns a camera's depth into true depth, from its calibration:
///   z' = scale (z + c0 + c1 Z + c2 Z^2),   z in mm, Z = z in metres,
///   c_k = a[0] + a[1] x + a[2] y + a[3] x^2 + a[4] x y + a[5] y^2,
/// x = (u - cx) / fx, y = (v - cy) / fy of the undistorted image. Our choice: the error of a
/// triangulating camera grows with z^2, and its lenses make it a smooth function of the place.
struct DepthCorrection {
  using Quadratic = std::array<double, 6>;
  double scale = 1.0;
  std::array<Quadratic, 3> polynomial{};  ///< c0 [mm], c1 [mm/m], c2 [mm/m^2]

  [[nodiscard]] bool isIdentity() const { return *this == DepthCorrection{}; }
  bool operator==(const DepthCorrection&) const = default;
};

/// The image with every measured depth corrected; what would come to lie behind the camera becomes
/// 0 as if not measured. Where the correction is the identity, every bit stays.
/// @param camera  pinhole of the undistorted depth image
[[nodiscard]] DepthImage corrected(DepthImage depth,
                                   const DepthCorrection& correction,
                                   const Intrinsics& camera);

}  // namespace tarsus
