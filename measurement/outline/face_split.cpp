#include "measurement/outline/face_split.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <set>
#include <vector>

namespace tarsus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    Structure,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// Faces reached from the outside without crossing the border: what rounding left between a
/// border point and the straight edge.
std::set<Triangulation::Face_handle> outsideOf(const Triangulation& triangulation,
                                               const std::set<std::pair<int, int>>& border) {
  std::vector<Triangulation::Face_handle> open{triangulation.infinite_face()};
  std::set<Triangulation::Face_handle> outside{open.front()};
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    for (int k = 0; k < 3; ++k) {
      const auto a = face->vertex(Triangulation::cw(k));
      const auto b = face->vertex(Triangulation::ccw(k));
      const bool infinite = triangulation.is_infinite(a) || triangulation.is_infinite(b);
      if (!infinite && border.contains(std::minmax(a->info(), b->info()))) {
        continue;
      }
      if (outside.insert(face->neighbor(k)).second) {
        open.push_back(face->neighbor(k));
      }
    }
  }
  return outside;
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> splitFace(const FaceToSplit& face) {
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> handles;
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    const auto before = triangulation.number_of_vertices();
    const auto handle = triangulation.insert({face.points[i].x(), face.points[i].y()});
    if (triangulation.number_of_vertices() == before) {
      return std::nullopt;  // two points fell on one place
    }
    handle->info() = static_cast<int>(i);
    handles.push_back(handle);
  }
  std::set<std::pair<int, int>> border;
  try {
    for (std::size_t i = 0; i < face.border.size(); ++i) {
      const int a = face.border[i];
      const int b = face.border[(i + 1) % face.border.size()];
      border.insert(std::minmax(a, b));
      triangulation.insert_constraint(handles[a], handles[b]);
    }
    for (const auto& [a, b] : face.segments) {
      triangulation.insert_constraint(handles[a], handles[b]);
    }
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  const auto outside = outsideOf(triangulation, border);
  std::vector<std::array<int, 3>> triangles;
  for (auto it = triangulation.finite_faces_begin(); it != triangulation.finite_faces_end(); ++it) {
    if (!outside.contains(it)) {
      triangles.push_back({it->vertex(0)->info(), it->vertex(1)->info(), it->vertex(2)->info()});
    }
  }
  return triangles;
}

}  // namespace tarsus
