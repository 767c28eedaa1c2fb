#pragma once

#include "reconstruction/scene/mesh.h"
#include "reconstruction/scene/rigid_motion.h"
#include "reconstruction/texture/keyframes.h"

#include <optional>

namespace tarsus {

/// Where a keyframe's depth says that its colour camera is, and how firmly. Colours alone do not
/// hold a picture's distance: all pictures together can shrink or grow on the surface with hardly
/// any contradiction.
struct PoseAnchor {
  RigidTransform color_from_scan = RigidTransform::Identity();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< motions turn about it [mm, colour camera]
  /// Mean square of how far a motion about the centre takes the surface along its normals, per
  /// square of the motion (motionOf in rigid_motion.h).
  MotionMatrix stiffness = MotionMatrix::Zero();
};

/// Lays the keyframe's depth on the model: point to plane along the pixels' rays, both from the
/// model, so that the sensor's noise does not couple with place or normal; directions that the
/// shape does not hold stay as the keyframe's pose has them.
/// @param mesh  scan frame [mm], with normals
/// @return  empty without enough depth on the model
[[nodiscard]] std::optional<PoseAnchor> anchorToDepth(const TriangleMesh& mesh,
                                                      const RgbdCamera& camera,
                                                      const Keyframe& keyframe);

/// The six numbers of the motion that takes `from` to `to`, both camera_from_scan.
[[nodiscard]] MotionVector motionBetween(const RigidTransform& from,
                                         const RigidTransform& to,
                                         const Eigen::Vector3d& center);

}  // namespace tarsus
