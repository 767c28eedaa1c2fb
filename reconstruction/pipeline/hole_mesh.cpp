#include "reconstruction/pipeline/hole_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>
#include <Eigen/Geometry>

#include <cmath>
#include <exception>

namespace tarsus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Eigen::Vector3d;

Point toCgal(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::vector<Point> toCgal(std::span<const Vector3d> points) {
  std::vector<Point> result;
  result.reserve(points.size());
  for (const Vector3d& p : points) {
    result.push_back(toCgal(p));
  }
  return result;
}

std::vector<Eigen::Vector3i> triangulated(std::span<const Vector3d> rim,
                                          std::span<const Vector3d> opposite) {
  std::vector<CGAL::Triple<int, int, int>> triangles;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
      toCgal(rim), toCgal(opposite), std::back_inserter(triangles));
  std::vector<Eigen::Vector3i> faces;
  for (const auto& t : triangles) {
    faces.emplace_back(t.first, t.second, t.third);
  }
  return faces;
}

double meanEdge(std::span<const Vector3d> rim) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    sum += (rim[(i + 1) % rim.size()] - rim[i]).norm();
  }
  return sum / static_cast<double>(rim.size());
}

FillMesh toFill(const Mesh& mesh) {
  FillMesh fill;
  for (const auto vertex : mesh.vertices()) {
    const Point& p = mesh.point(vertex);
    fill.points.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : mesh.faces()) {
    Eigen::Vector3i corners;
    int k = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
      corners[k++] = static_cast<int>(vertex.idx());
    }
    fill.faces.push_back(corners);
  }
  return fill;
}

std::optional<FillMesh> meshed(std::span<const Vector3d> rim,
                               std::span<const Vector3d> opposite,
                               double edge_mm,
                               FillStart start) {
  const int count = static_cast<int>(rim.size());
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Point& p : toCgal(rim)) {
    vertices.push_back(mesh.add_vertex(p));
  }
  std::vector<Eigen::Vector3i> triangles;
  if (start == FillStart::Fan) {
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : rim) {
      middle += p;
    }
    vertices.push_back(mesh.add_vertex(toCgal(Vector3d(middle / static_cast<double>(count)))));
    for (int i = 0; i < count; ++i) {
      triangles.emplace_back(i, (i + 1) % count, count);
    }
  } else {
    triangles = triangulated(rim, opposite);
    if (static_cast<int>(triangles.size()) != count - 2) {
      return std::nullopt;
    }
  }
  for (const Eigen::Vector3i& t : triangles) {
    const auto corner = [&](int k) { return vertices[static_cast<std::size_t>(t[k])]; };
    if (mesh.add_face(corner(0), corner(1), corner(2)) == Mesh::null_face()) {
      return std::nullopt;
    }
  }
  if (count > 3) {
    // CGAL measures density by the edges of the rim; those of marching cubes are shorter than the
    // mesh's own.
    const std::vector<Mesh::Face_index> all(mesh.faces().begin(), mesh.faces().end());
    std::vector<Mesh::Face_index> new_faces;
    std::vector<Mesh::Vertex_index> new_vertices;
    CGAL::Polygon_mesh_processing::refine(
        mesh,
        all,
        std::back_inserter(new_faces),
        std::back_inserter(new_vertices),
        CGAL::parameters::density_control_factor(std::sqrt(2.0) * meanEdge(rim) / edge_mm));
  }
  return toFill(mesh);
}

Vector3d areaVector(const NamedTriangle& t) {
  return (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]);
}

/// Two triangles along a common edge: whether one lies back on the other.
bool folded(const NamedTriangle& a, const NamedTriangle& b) {
  constexpr double kFoldCosine = -0.98;
  const Vector3d normal_a = areaVector(a);
  const Vector3d normal_b = areaVector(b);
  const double lengths = normal_a.norm() * normal_b.norm();
  constexpr double kSliver_mm4 = 1e-6;  // the direction of less means nothing
  return lengths > kSliver_mm4 && normal_a.dot(normal_b) < kFoldCosine * lengths;
}

bool boxesApart(const NamedTriangle& a, const NamedTriangle& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto range = [axis](const NamedTriangle& t) {
      return std::minmax({t.corners[0][axis], t.corners[1][axis], t.corners[2][axis]});
    };
    const auto [low_a, high_a] = range(a);
    const auto [low_b, high_b] = range(b);
    if (high_a < low_b || high_b < low_a) {
      return true;
    }
  }
  return false;
}

Kernel::Triangle_3 toCgal(const NamedTriangle& t) {
  return {toCgal(t.corners[0]), toCgal(t.corners[1]), toCgal(t.corners[2])};
}

bool sideCuts(const NamedTriangle& a, int shared_corner, const NamedTriangle& b) {
  const Kernel::Segment_3 side(
      toCgal(a.corners[static_cast<std::size_t>((shared_corner + 1) % 3)]),
      toCgal(a.corners[static_cast<std::size_t>((shared_corner + 2) % 3)]));
  const Kernel::Triangle_3 triangle = toCgal(b);
  return !triangle.is_degenerate() && !side.is_degenerate() && CGAL::do_intersect(side, triangle);
}

struct SharedCorners {
  int count = 0;
  int of_a = 0;  ///< the last of them
  int of_b = 0;
};

SharedCorners sharedCorners(const NamedTriangle& a, const NamedTriangle& b) {
  SharedCorners shared;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (a.names[i] == b.names[j]) {
        shared = {shared.count + 1, i, j};
      }
    }
  }
  return shared;
}

bool cross(const NamedTriangle& a, const NamedTriangle& b) {
  if (boxesApart(a, b)) {
    return false;
  }
  const SharedCorners shared = sharedCorners(a, b);
  if (shared.count >= 2) {
    return shared.count == 3 || folded(a, b);
  }
  if (shared.count == 1) {
    return sideCuts(a, shared.of_a, b) || sideCuts(b, shared.of_b, a);
  }
  const Kernel::Triangle_3 first = toCgal(a);
  const Kernel::Triangle_3 second = toCgal(b);
  return !first.is_degenerate() && !second.is_degenerate() && CGAL::do_intersect(first, second);
}

}  // namespace

std::optional<FillMesh> meshHole(std::span<const Vector3d> rim,
                                 std::span<const Vector3d> opposite,
                                 double edge_mm,
                                 FillStart start) {
  try {
    return meshed(rim, opposite, edge_mm, start);
  } catch (const std::exception&) {  // a failed check inside CGAL: the hole stays open
    return std::nullopt;
  }
}

bool crosses(std::span<const NamedTriangle> filling, std::span<const NamedTriangle> others) {
  for (std::size_t i = 0; i < filling.size(); ++i) {
    for (std::size_t j = i + 1; j < filling.size(); ++j) {
      if (cross(filling[i], filling[j])) {
        return true;
      }
    }
    for (const NamedTriangle& other : others) {
      if (cross(filling[i], other)) {
        return true;
      }
    }
  }
  return false;
}

bool meet(std::span<const NamedTriangle> a, std::span<const NamedTriangle> b) {
  for (const NamedTriangle& first : a) {
    for (const NamedTriangle& second : b) {
      if (sharedCorners(first, second).count >= 2 || cross(first, second)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace tarsus
