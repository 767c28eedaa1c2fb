#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/simulator/dense_mesh.h"

#include <Eigen/Core>

#include <filesystem>
#include <functional>

namespace tarsus {

/// A healthy foot before its ulcers. Foot frame: x from heel to toes, z up the leg; the sole
/// touches z = 0, the heel x = 0 [mm].
struct IntactFoot {
  DenseMesh mesh;
  double length_mm = 260.0;
  double toe_bend_rad = 0.0;
  double medial_y = 1.0;  ///< +1: the big toe is on the side of +y (a right foot), -1: a left one
  Eigen::Vector3d heel = Eigen::Vector3d::Zero();  ///< most posterior point of the heel pad
  Eigen::Vector3d toe = Eigen::Vector3d::Zero();   ///< tip of the second toe
  /// Onto the true skin, for new vertices; empty: faces are flat as they came.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> project;
  /// Distance to the skin, positive outside; empty where unknown.
  std::function<double(const Eigen::Vector3d&)> distance;

  /// A point of the 260 mm right foot carried over to this one.
  [[nodiscard]] Eigen::Vector3d fromStandard(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d toStandard(const Eigen::Vector3d& p) const;
};

/// The project's own foot, about 1 mm fine.
/// @param toe_bend_rad  of all toes, towards the sole
[[nodiscard]] IntactFoot makeOwnFoot(double toe_bend_rad = 0.0);

/// A foot from a closed mesh in metres or millimetres, in any pose: the longest extent becomes
/// heel-toe, the flat side the sole, the leg's end tells the heel, the big toe the side.
/// @errors FileMissing, FileUnreadable, MeshInvalid (not closed, not the size of a foot)
[[nodiscard]] Expected<IntactFoot> loadFoot(const std::filesystem::path& path);

}  // namespace tarsus
