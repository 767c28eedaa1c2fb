#pragma once

#include "reconstruction/scene/frame.h"

#include <functional>
#include <memory>
#include <vector>

namespace tarsus {

/// A reading of one frame against the surface as it is believed so far, scan frame.
struct PoseObservation {
  Eigen::Vector3f p = Eigen::Vector3f::Zero();       ///< on the surface [mm]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< of the surface, unit
  float residual_mm = 0.0F;                          ///< reading over the tangent plane at p
  float weight = 1.0F;
};

/// What frame i sees from a pose (scan_from_camera); called for several frames at once.
using ObserveFrame =
    std::function<std::vector<PoseObservation>(std::size_t i, const RigidTransform& pose)>;

/// Bundle adjustment on depth: all poses at once, the surface's patches (cubes of 8 mm) free to
/// rise or sink along their normals. The patches are eliminated by Schur's complement, the reduced
/// equations in the poses solved by conjugate gradients. Private to fusion/.
class PoseAdjustment {
 public:
  /// @param center  of the scene [mm], about which frames turn
  PoseAdjustment(std::vector<RigidTransform> start,
                 const Eigen::Vector3d& center,
                 ObserveFrame observe);
  PoseAdjustment(const PoseAdjustment&) = delete;
  PoseAdjustment& operator=(const PoseAdjustment&) = delete;
  PoseAdjustment(PoseAdjustment&&) = delete;
  PoseAdjustment& operator=(PoseAdjustment&&) = delete;
  ~PoseAdjustment();

  /// One step of Gauss-Newton.
  /// @param kernel_mm  Tukey's
  /// @return the largest motion of a frame against the first [mm, 100 mm from the centre]
  double sweep(double kernel_mm);
  [[nodiscard]] const std::vector<RigidTransform>& poses() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
