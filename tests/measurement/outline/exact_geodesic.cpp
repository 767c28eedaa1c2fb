#include "tests/measurement/outline/exact_geodesic.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

namespace tarsus::test {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Traits = CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>;
using ShortestPath = CGAL::Surface_mesh_shortest_path<Traits>;

double exactGeodesic(const SurfacePatch& patch, const SurfaceNode& from, const SurfaceNode& to) {
  Mesh mesh;
  for (const auto& p : patch.vertices) {
    mesh.add_vertex({p.x(), p.y(), p.z()});
  }
  std::vector<Mesh::Face_index> faces;
  for (const auto& f : patch.faces) {
    faces.push_back(mesh.add_face(
        Mesh::Vertex_index(f[0]), Mesh::Vertex_index(f[1]), Mesh::Vertex_index(f[2])));
  }
  // CGAL counts barycentric coordinates from the target of the face's first half-edge's source.
  const auto coordinates = [&](const SurfaceNode& node) {
    const auto source = mesh.source(mesh.halfedge(faces[node.face]));
    const int first = patch.cornerOf(node.face, static_cast<int>(source));
    const auto& b = node.barycentric;
    return Traits::Barycentric_coordinates{b[first], b[(first + 1) % 3], b[(first + 2) % 3]};
  };
  ShortestPath paths(mesh);
  paths.add_source_point(faces[from.face], coordinates(from));
  return paths.shortest_distance_to_source_points(faces[to.face], coordinates(to)).first;
}

}  // namespace tarsus::test
