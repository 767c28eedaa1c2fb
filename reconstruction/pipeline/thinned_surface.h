#pragma once

#include "reconstruction/scene/mesh.h"

#include <vector>

namespace tarsus {

/// A surface thinned to at most one of its vertices in a cell of space.
struct ThinnedSurface {
  std::vector<Eigen::Vector3f> points;   ///< scan frame [mm]
  std::vector<Eigen::Vector3f> normals;  ///< outward
  std::vector<int> point_of_vertex;      ///< #V of the surface
};

/// @param mesh  with normals
[[nodiscard]] ThinnedSurface thinned(const TriangleMesh& mesh, double cell_mm);

/// Groups of at least `min_points` of the points `members` that lie within `gap_mm` of each other,
/// the largest first; each in ascending order.
/// Source: Rusu, PhD thesis, TU Munich 2009 (Euclidean clusters), as PCL has it.
[[nodiscard]] std::vector<std::vector<int>> clustersOf(const ThinnedSurface& surface,
                                                       const std::vector<int>& members,
                                                       double gap_mm,
                                                       int min_points);

}  // namespace tarsus
