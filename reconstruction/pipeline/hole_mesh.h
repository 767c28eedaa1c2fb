#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace tarsus {

/// A disc of triangles that fills a rim; counter-clockwise along the rim. No edge inside joins two
/// points of the rim: each face has a point of its own (to be marked), and no edge can be one that
/// the surface has already.
struct FillMesh {
  std::vector<Eigen::Vector3d> points;  ///< the rim first, in its order [mm]
  std::vector<Eigen::Vector3i> faces;
};

/// How a filling is begun: by the triangulation with the least bends, or by a fan about the middle,
/// which fills where the first finds nothing.
enum class FillStart { Triangulation, Fan };

/// Fills a rim with triangles whose edges are about `edge_mm` long. Not smooth yet.
/// Source: Liepa, Filling holes in meshes, SGP 2003, as CGAL has it.
/// @param rim       in the direction of the filling's faces [mm]
/// @param opposite  third point of the face beyond the edge from rim[i] to rim[i + 1]
/// @return  nothing where no triangulation without degenerate triangles was found
[[nodiscard]] std::optional<FillMesh> meshHole(std::span<const Eigen::Vector3d> rim,
                                               std::span<const Eigen::Vector3d> opposite,
                                               double edge_mm,
                                               FillStart start);

struct NamedTriangle {
  std::array<Eigen::Vector3d, 3> corners;  ///< [mm]
  Eigen::Vector3i names;                   ///< equal where corners are shared
};

/// Whether a triangle of the filling cuts another of it or of `others`, or lies folded back on it.
[[nodiscard]] bool crosses(std::span<const NamedTriangle> filling,
                           std::span<const NamedTriangle> others);

/// Whether two fillings cut each other or share an edge, which the surface has twice already.
[[nodiscard]] bool meet(std::span<const NamedTriangle> a, std::span<const NamedTriangle> b);

}  // namespace tarsus
