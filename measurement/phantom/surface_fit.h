#pragma once

#include "measurement/phantom/pose_search.h"
#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh_index.h"

#include <span>

namespace tarsus {

/// A rigid motion after a change of size.
struct Similarity {
  RigidTransform rigid = RigidTransform::Identity();
  double scale = 1.0;

  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p) const {
    return rigid * (scale * p);
  }
};

/// Points of a known surface and the model that they are laid onto [mm].
struct FitPair {
  const OrientedPoints& samples;
  const TriangleMesh& model;
  const MeshIndex& index;
};

/// Robust point-to-plane fit along the samples' own normals, which carry no noise: Gauss-Newton
/// with Tukey weights; a sample counts where the model lies near it and faces the same way.
/// Source: Chen and Medioni, IVC 10(3), 1992; the rest our choice.
/// @param reaches_mm  one step each, of Tukey's weights
[[nodiscard]] Similarity fitSurface(const FitPair& pair,
                                    const Similarity& start,
                                    std::span<const double> reaches_mm,
                                    bool with_scale);

struct FitQuality {
  double inlier_share = 0.0;  ///< of the samples, with the model within the reach, facing the same
  double rms_mm = 0.0;        ///< of those, along the samples' normals
  double cost_mm2 = 0.0;      ///< mean squared distance, no sample more than the reach
};
[[nodiscard]] FitQuality qualityOf(const FitPair& pair, const Similarity& fit, double reach_mm);

}  // namespace tarsus
