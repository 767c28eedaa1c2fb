#pragma once

#include "reconstruction/scene/frame.h"
#include "reconstruction/scene/mesh.h"

#include <functional>
#include <vector>

namespace tarsus {

/// A surface as evenly spread points with unit normals.
struct OrientedPoints {
  std::vector<Eigen::Vector3d> positions_mm;
  std::vector<Eigen::Vector3d> normals;
};

/// One point for each cubic cell that holds surface: the mean of its vertices by the area around
/// them. Cells over an edge, whose normals disagree, are left out.
[[nodiscard]] OrientedPoints orientedPoints(const TriangleMesh& mesh, double cell_mm);

/// Poses in which the body may lie in the scene, the most voted first; clutter and missing parts
/// are allowed for, a start is not needed.
/// Source: Drost, Ulrich, Navab and Ilic, CVPR 2010 (votes of oriented point pairs).
/// @return  scene_from_body, within some degrees and points' distances; empty where nothing is
///          alike
[[nodiscard]] std::vector<RigidTransform> searchPoses(const OrientedPoints& body,
                                                      const OrientedPoints& scene,
                                                      int most);

}  // namespace tarsus
