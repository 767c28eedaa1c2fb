#pragma once

#include "reconstruction/scene/mesh.h"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace tarsus {

/// A closed mesh under construction, in double precision so that splitting it does not move it.
struct DenseMesh {
  std::vector<Eigen::Vector3d> positions;  ///< [mm]
  std::vector<Eigen::Vector3i> faces;      ///< counter-clockwise from outside
};

/// Meshes the zero set of a distance field with one vertex per crossed cell ("surface nets",
/// Gibson 1998), pulled onto the zero set by `project`. Closed where the set is.
/// @param distance  [mm], Lipschitz constant about 1, positive outside
struct ZeroSet {
  std::function<double(const Eigen::Vector3d&)> distance;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> project;
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
};
[[nodiscard]] DenseMesh meshZeroSet(const ZeroSet& set, double step_mm);

/// Splits edges that are too long until none is or the rounds are used up. Faces stay joined.
/// @param too_long  of the two ends' indices; must be symmetric
/// @param split     called in order for each new vertex with the ends; appends whatever else the
///                  caller keeps per vertex
/// @param parent_of_face  optional; children inherit their parent's value
struct Refinement {
  std::function<bool(int, int)> too_long;
  std::function<void(const std::vector<Eigen::Vector2i>& ends)> split;
  int rounds = 3;
};
void refine(std::vector<Eigen::Vector3i>& faces,
            std::vector<int>* label_of_face,
            int vertex_count,
            const Refinement& rule);

/// Area-weighted unit normals.
[[nodiscard]] std::vector<Eigen::Vector3d> normalsOf(const DenseMesh& mesh);

[[nodiscard]] TriangleMesh toTriangleMesh(const DenseMesh& mesh);

}  // namespace tarsus
