#include "reconstruction/pipeline/hole_mesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>
#include <Eigen/Geometry>

#include <cmath>
#include <exception>
#include <map>

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

/// New points on the edges between two corners of the rim, so that each face of a narrow filling
/// has a corner of its own, which can be marked as made up.
class ChordSplitter {
 public:
  ChordSplitter(FillMesh& fill, int rim_size) : fill_(fill), rim_size_(rim_size) {
    for (const Eigen::Vector3i& f : fill.faces) {
      for (int k = 0; k < 3; ++k) {
        ++faces_at_edge_[std::minmax(f[k], f[(k + 1) % 3])];
      }
    }
  }

  void split() {
    std::vector<Eigen::Vector3i> old_faces;
    std::swap(old_faces, fill_.faces);
    for (const Eigen::Vector3i& f : old_faces) {
      if ((f.array() < rim_size_).all() && rim_size_ == 3) {
        splitAtCenter(f);
      } else {
        splitFace(f, {middle(f[0], f[1]), middle(f[1], f[2]), middle(f[2], f[0])});
      }
    }
  }

 private:
  /// The new point on an edge; -1 where it stays whole.
  int middle(int a, int b) {
    const std::pair<int, int> edge = std::minmax(a, b);
    if (a >= rim_size_ || b >= rim_size_ || faces_at_edge_.at(edge) < 2) {
      return -1;
    }
    const auto [entry, is_new] = middles_.emplace(edge, static_cast<int>(fill_.points.size()));
    if (is_new) {
      addPoint((at(a) + at(b)) / 2.0);
    }
    return entry->second;
  }

  void splitAtCenter(const Eigen::Vector3i& f) {
    const int center = static_cast<int>(fill_.points.size());
    addPoint((at(f[0]) + at(f[1]) + at(f[2])) / 3.0);
    for (int k = 0; k < 3; ++k) {
      fill_.faces.emplace_back(f[k], f[(k + 1) % 3], center);
    }
  }

  /// @param m  new points on the edges 01, 12 and 20, or -1
  void splitFace(const Eigen::Vector3i& f, const Eigen::Vector3i& m) {
    const int count = static_cast<int>((m.array() >= 0).count());
    if (count == 0) {
      fill_.faces.push_back(f);
    } else if (count == 3) {
      for (int k = 0; k < 3; ++k) {
        fill_.faces.emplace_back(f[k], m[k], m[(k + 2) % 3]);
      }
      fill_.faces.push_back(m);
    } else {
      // Turned so that edge 01 is split and, where two are, edge 12 is the other.
      int k = 0;
      while (m[k] < 0 || (count == 2 && m[(k + 1) % 3] < 0)) {
        ++k;
      }
      const int a = f[k];
      const int b = f[(k + 1) % 3];
      const int c = f[(k + 2) % 3];
      if (count == 1) {
        fill_.faces.emplace_back(a, m[k], c);
        fill_.faces.emplace_back(m[k], b, c);
      } else {
        fill_.faces.emplace_back(m[k], b, m[(k + 1) % 3]);
        fill_.faces.emplace_back(a, m[k], m[(k + 1) % 3]);
        fill_.faces.emplace_back(a, m[(k + 1) % 3], c);
      }
    }
  }

  Vector3d at(int i) const { return fill_.points[static_cast<std::size_t>(i)]; }
  void addPoint(const Vector3d& p) { fill_.points.push_back(p); }

  FillMesh& fill_;
  int rim_size_;
  std::map<std::pair<int, int>, int> faces_at_edge_;
  std::map<std::pair<int, int>, int> middles_;
};

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
  FillMesh fill = toFill(mesh);
  ChordSplitter(fill, count).split();
  return fill;
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
