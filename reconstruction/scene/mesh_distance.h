#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"

#include <optional>
#include <vector>

namespace tarsus {

/// Distances from samples on one mesh to the nearest point of another [mm].
struct DistanceStatistics {
  double mean_mm = 0.0;
  double rms_mm = 0.0;
  double p95_mm = 0.0;
  double max_mm = 0.0;
  int count = 0;
};

/// Only what lies inside this ball is sampled [mm, frame of the meshes].
struct Ball {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

struct MeshComparison {
  DistanceStatistics a_to_b;
  DistanceStatistics b_to_a;
  double symmetric_rms_mm = 0.0;
  double hausdorff_mm = 0.0;
  double completeness_1mm = 0.0;            ///< share of b's samples within 1 mm of a
  std::vector<float> a_vertex_distance_mm;  ///< #V of a, for the heat map; NaN outside the region
};

struct MeshDistanceOptions {
  /// Area-uniform, beside one sample at every vertex, and never fewer than there are vertices:
  /// MeshLab's filter takes as many of either kind.
  double samples_per_mm2 = 1.0;
  bool align_icp = false;  ///< rigid point-to-plane fit of a onto b first
  std::optional<Ball> region;
};

/// Compares model `a` with reference `b` in both directions, as MeshLab's "Hausdorff Distance"
/// filter: samples on vertices and faces, each to the nearest point of the other surface.
/// @errors MeshInvalid, SurfaceEmpty (region holds no surface)
[[nodiscard]] Expected<MeshComparison> compareMeshes(const TriangleMesh& a,
                                                     const TriangleMesh& b,
                                                     const MeshDistanceOptions& options);

}  // namespace tarsus
