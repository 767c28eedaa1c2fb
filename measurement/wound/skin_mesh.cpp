#include "measurement/wound/skin_mesh.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace tarsus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_2<Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
// The projected outline may cross itself where the bed hangs over; crossings become points.
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

double distanceToOutline(const Eigen::Vector2d& p, std::span<const Eigen::Vector2d> outline) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& q : outline) {
    least = std::min(least, (p - q).squaredNorm());
  }
  return std::sqrt(least);
}

void insertGrid(Triangulation& triangulation,
                std::span<const Eigen::Vector2d> outline,
                double edge_mm) {
  Eigen::Vector2d low = outline.front();
  Eigen::Vector2d high = outline.front();
  for (const auto& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto steps = [&](double length) { return static_cast<int>(std::ceil(length / edge_mm)); };
  for (int j = 0; j <= steps(high.y() - low.y()); ++j) {
    for (int i = 0; i <= steps(high.x() - low.x()); ++i) {
      const Eigen::Vector2d p = low + edge_mm * Eigen::Vector2d(i + 0.5 * (j % 2), j);
      if (distanceToOutline(p, outline) > 0.6 * edge_mm) {
        triangulation.insert({p.x(), p.y()});
      }
    }
  }
}

/// Faces inside the outline: those an odd number of outline crossings away from infinity.
std::set<Triangulation::Face_handle> insideOf(const Triangulation& triangulation) {
  std::map<Triangulation::Face_handle, int> crossings{{triangulation.infinite_face(), 0}};
  std::vector<Triangulation::Face_handle> open{triangulation.infinite_face()};
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    for (int k = 0; k < 3; ++k) {
      const int level = crossings[face] + (triangulation.is_constrained({face, k}) ? 1 : 0);
      if (crossings.emplace(face->neighbor(k), level).second) {
        open.push_back(face->neighbor(k));
      }
    }
  }
  std::set<Triangulation::Face_handle> inside;
  for (const auto& [face, count] : crossings) {
    if (count % 2 == 1) {
      inside.insert(face);
    }
  }
  return inside;
}

}  // namespace

TriangleMesh meshSkin(const ReferenceSkin& skin,
                      std::span<const Eigen::Vector2d> outline,
                      double edge_mm) {
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> handles;
  for (const auto& p : outline) {
    handles.push_back(triangulation.insert({p.x(), p.y()}));
  }
  for (std::size_t i = 0; i < handles.size(); ++i) {
    if (handles[i] != handles[(i + 1) % handles.size()]) {
      triangulation.insert_constraint(handles[i], handles[(i + 1) % handles.size()]);
    }
  }
  insertGrid(triangulation, outline, edge_mm);
  const auto inside = insideOf(triangulation);
  TriangleMesh mesh;
  std::map<Triangulation::Vertex_handle, int> number;
  for (auto it = triangulation.finite_faces_begin(); it != triangulation.finite_faces_end(); ++it) {
    if (!inside.contains(it)) {
      continue;
    }
    Eigen::Vector3i face;
    for (int k = 0; k < 3; ++k) {
      const auto vertex = it->vertex(k);
      const auto [entry, is_new] = number.emplace(vertex, static_cast<int>(mesh.vertices.size()));
      if (is_new) {
        const auto& p = vertex->point();
        mesh.vertices.push_back(skin.at({p.x(), p.y()}).cast<float>());
      }
      face[k] = entry->second;
    }
    mesh.faces.push_back(face);
  }
  mesh.normals = vertexNormals(mesh);
  return mesh;
}

}  // namespace tarsus
