#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"

namespace tarsus {

/// What of a mesh a camera sees first, pixel by pixel.
struct SurfaceImage {
  DepthImage depth_mm;  ///< z at the pixel's centre, 0 where there is no surface
  Image<int> face;      ///< -1 where there is no surface
};

/// The model's own z-buffer. Both sides of a face hide what lies behind it. Faces that reach behind
/// the camera are left out.
/// @param camera_from_mesh  mesh frame to the pinhole camera
[[nodiscard]] SurfaceImage rasterize(const TriangleMesh& mesh,
                                     const Intrinsics& camera,
                                     const Eigen::Isometry3f& camera_from_mesh);

}  // namespace tarsus
