#pragma once

#include "reconstruction/pipeline/background.h"
#include "reconstruction/pipeline/thinned_surface.h"

#include <vector>

namespace tarsus {

/// A bench, wall or floor.
struct SupportPlane {
  Eigen::Vector3f normal;  ///< unit, towards the cameras
  float offset_mm = 0.0F;  ///< normal . p on the plane

  [[nodiscard]] float distance(const Eigen::Vector3f& p) const { return normal.dot(p) - offset_mm; }
};

struct SupportPlanes {
  std::vector<SupportPlane> planes;
  std::vector<int> plane_of_point;  ///< #points: -1 where it belongs to none
};

/// Large flat patches that carry or back the scene. A patch is support when it is larger than any
/// flat of a foot, or has more of the scene before it than behind (the flat of a sole has the foot
/// behind it); what was cut off already does not count as scene.
/// Source: Fischler and Bolles, CACM 24(6), 1981 (RANSAC on points and normals), as PCL has it.
[[nodiscard]] SupportPlanes findSupportPlanes(const ThinnedSurface& surface,
                                              const BackgroundOptions& options);

}  // namespace tarsus
