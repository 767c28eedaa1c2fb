#pragma once

#include "reconstruction/fusion/loop_measurement.h"

#include <vector>

namespace tarsus {

/// A place as its earlier visit saw it, as two fields.
struct VisitedPlace {
  /// @param window  entries of the trajectory, with poses
  VisitedPlace(const ScanArchive& frames,
               const Trajectory& trajectory,
               std::span<const std::size_t> window,
               const LoopMeasureOptions& options);

  TsdfVolume coarse;  ///< wide band: reaches far
  TsdfVolume fine;
};

/// What one frame of the later visit saw.
struct VisitFrame {
  std::size_t index = 0;  ///< entry of the trajectory
  RigidTransform scan_from_camera = RigidTransform::Identity();
  FramePoints points;
};

struct VisitAlignment {
  RigidTransform motion = RigidTransform::Identity();  ///< of the visit as one body, scan frame
  Eigen::Vector3d center = Eigen::Vector3d::Zero();    ///< of its points before it, scan frame
  /// Mean over the points of what they say about the motion vector about the moved centre, in the
  /// axes of the scan: 1 where all normals point that way, nothing along free directions.
  MotionMatrix sensitivity = MotionMatrix::Zero();
  int free_directions = 0;       ///< of the 6
  double inlier_fraction = 0.0;  ///< of the points with a surface near them
  double shared_fraction = 0.0;  ///< of all points, those with a surface near them
  double rmse_mm = 0.0;          ///< of the points to the surface
};

/// Moves the later visit as one rigid body onto the place, first by the fields' values, at last
/// where the pixels' rays meet the surface (align.h). Directions that the surface leaves free are
/// not moved.
/// @param scan_from_later  of the frame in whose axes the first steps are taken
[[nodiscard]] VisitAlignment alignVisit(const VisitedPlace& place,
                                        const std::vector<VisitFrame>& visit,
                                        const RigidTransform& scan_from_later,
                                        const LoopMeasureOptions& options);

/// Every how many points, to leave about so many.
[[nodiscard]] std::size_t strideFor(std::size_t count, int most);

}  // namespace tarsus
