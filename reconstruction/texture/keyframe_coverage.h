#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/image.h"
#include "reconstruction/scene/mesh.h"

#include <span>
#include <vector>

namespace tarsus {

/// How well an even choice of a surface's vertices is seen from each of some places.
struct CoverageTable {
  Image<float> worth;   ///< a row per place: cos^2 / z^2 against the vertex's best, 0 = not seen
  Image<float> cosine;  ///< of the angle between view and normal, same shape

  [[nodiscard]] int places() const { return worth.height(); }
  [[nodiscard]] int vertices() const { return worth.width(); }
};

/// A vertex is seen where the colour camera has it in its image, turned no further than
/// `max_view_angle_deg`, and with no other part of the surface before it.
/// @param surface  scan frame [mm], with normals
/// @param scan_from_camera  poses of the depth camera
[[nodiscard]] CoverageTable coverageOf(const TriangleMesh& surface,
                                       const RgbdCamera& camera,
                                       std::span<const RigidTransform> scan_from_camera,
                                       double max_view_angle_deg);

}  // namespace tarsus
