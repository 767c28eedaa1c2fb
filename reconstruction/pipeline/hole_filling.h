#pragma once

#include "reconstruction/pipeline/face_grid.h"
#include "reconstruction/pipeline/hole_closing.h"
#include "reconstruction/pipeline/hole_loops.h"
#include "reconstruction/pipeline/hole_mesh.h"

#include <optional>
#include <vector>

namespace tarsus {

/// What all holes of a surface share.
struct HoleSite {
  const ExtractedSurface& surface;
  const HoleOptions& options;
  VertexFaces around;
  FaceGrid grid;
  std::vector<Eigen::Vector3f> normals;

  [[nodiscard]] Eigen::Vector3d at(int vertex) const {
    return surface.mesh.vertices[static_cast<std::size_t>(vertex)].cast<double>();
  }
};

/// Vertices and faces that close one hole. Face corners below `rim.size()` are the rim's, the
/// others new vertices in their order.
struct Filling {
  std::vector<int> rim;  ///< vertices of the surface, in the filling's direction
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3i> faces;
  double area_mm2 = 0.0;
};

/// @return  a smooth filling that touches the surface in its rim alone, or nothing
[[nodiscard]] std::optional<Filling> fillHole(const HoleSite& site, const BorderLoop& loop);

[[nodiscard]] NamedTriangle namedTriangle(const TriangleMesh& mesh, int face);

/// @param first_name  of the filling's first new vertex; the rim keeps the surface's names
[[nodiscard]] std::vector<NamedTriangle> namedTriangles(const HoleSite& site,
                                                        const Filling& filling,
                                                        int first_name);

[[nodiscard]] Eigen::AlignedBox3f boxOf(const std::vector<NamedTriangle>& triangles);

}  // namespace tarsus
