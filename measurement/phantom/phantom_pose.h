#pragma once

#include "measurement/phantom/surface_fit.h"
#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh_distance.h"

namespace tarsus {

/// Where a phantom lies in a model, found by its shape alone.
struct PhantomPose {
  Similarity model_from_phantom;  ///< size and pose that fit best: carries the outlines over
  FitQuality quality;             ///< of that
  FitQuality at_true_size;        ///< of the best fit without a change of size
};

struct PhantomPoseOptions {
  /// Refused below and above: clinical practice's limits for laying one visit on another.
  double least_inlier_share = 0.6;
  double most_rms_mm = 0.7;
  double reach_mm = 2.0;  ///< farther from the surface is no inlier
  /// Another pose that fits nearly as well makes the finding worthless.
  double least_cost_ratio = 1.5;
};

/// @param body   closed, z up from its base; only what a camera above sees of it is looked for
/// @param model  a scan of it, other things around allowed
/// @errors PhantomNotFound
[[nodiscard]] Expected<PhantomPose> findPhantom(const TriangleMesh& body,
                                                const TriangleMesh& model,
                                                const MeshIndex& index,
                                                const PhantomPoseOptions& options = {});

/// Share of the phantom's upper side within a ball (phantom frame) that the model shows there.
[[nodiscard]] double shareWithin(const TriangleMesh& body,
                                 const Ball& ball,
                                 const TriangleMesh& model,
                                 const MeshIndex& index,
                                 const Similarity& model_from_phantom);

}  // namespace tarsus
