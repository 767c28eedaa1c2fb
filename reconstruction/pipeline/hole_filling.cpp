#include "reconstruction/pipeline/hole_filling.h"

#include "reconstruction/pipeline/hole_fairing.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// Faces within `reach_mm` of the rim, going from face to face.
std::vector<int> facesNear(const HoleSite& site, const std::vector<int>& rim, double reach_mm) {
  std::set<int> faces;
  std::set<int> seen(rim.begin(), rim.end());
  std::vector<int> open = rim;
  const auto is_near = [&](int vertex) {
    const Vector3d p = site.at(vertex);
    return std::ranges::any_of(rim, [&](int r) { return (site.at(r) - p).norm() <= reach_mm; });
  };
  while (!open.empty()) {
    const auto v = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (int i = site.around.first[v]; i < site.around.first[v + 1]; ++i) {
      const int face = site.around.faces[static_cast<std::size_t>(i)];
      if (!faces.insert(face).second) {
        continue;
      }
      for (const int corner : site.surface.mesh.faces[static_cast<std::size_t>(face)]) {
        if (!seen.contains(corner) && is_near(corner)) {
          seen.insert(corner);
          open.push_back(corner);
        }
      }
    }
  }
  return {faces.begin(), faces.end()};
}

/// Edge of an equilateral triangle of the faces' mean area: unlike the mean edge, slivers leave it.
double typicalEdge(const HoleSite& site, const std::vector<int>& faces) {
  double area = 0.0;
  for (const int face : faces) {
    const Eigen::Vector3i& f = site.surface.mesh.faces[static_cast<std::size_t>(face)];
    area += 0.5 * (site.at(f[1]) - site.at(f[0])).cross(site.at(f[2]) - site.at(f[0])).norm();
  }
  return std::sqrt(4.0 / std::numbers::sqrt3 * area / static_cast<double>(faces.size()));
}

/// Known better or worse than its neighbours, where the surface says so.
double trustOf(const ExtractedSurface& surface, int vertex, double usual_sigma_mm) {
  if (surface.sigma_mm.empty() || usual_sigma_mm <= 0.0) {
    return 1.0;
  }
  const double sigma = surface.sigma_mm[static_cast<std::size_t>(vertex)];
  const double ratio = usual_sigma_mm / std::max(sigma, 0.1 * usual_sigma_mm);
  return std::clamp(ratio * ratio, 0.1, 4.0);
}

double medianSigma(const ExtractedSurface& surface, const std::map<int, int>& vertices) {
  std::vector<float> sigmas;
  if (!surface.sigma_mm.empty()) {
    for (const auto& [vertex, name] : vertices) {
      sigmas.push_back(surface.sigma_mm[static_cast<std::size_t>(vertex)]);
    }
  }
  if (sigmas.empty()) {
    return 0.0;
  }
  const auto middle = sigmas.begin() + std::ssize(sigmas) / 2;
  std::ranges::nth_element(sigmas, middle);
  return *middle;
}

/// Whether the faces round each point of the patch close a full turn.
void markInner(FairingPatch& patch) {
  std::map<std::pair<int, int>, int> faces_at_edge;
  for (const Eigen::Vector3i& f : patch.faces) {
    for (int k = 0; k < 3; ++k) {
      ++faces_at_edge[std::minmax(f[k], f[(k + 1) % 3])];
    }
  }
  patch.inner.assign(patch.points.size(), 1);
  for (const auto& [edge, count] : faces_at_edge) {
    if (count != 2) {
      patch.inner[static_cast<std::size_t>(edge.first)] = 0;
      patch.inner[static_cast<std::size_t>(edge.second)] = 0;
    }
  }
}

/// The filling's points moved so that they continue the surface.
/// @return false where no smooth filling exists
bool fair(const HoleSite& site,
          const std::vector<int>& near,
          double edge_mm,
          const std::vector<int>& rim,
          FillMesh& fill) {
  FairingPatch patch{.points = fill.points, .faces = fill.faces};
  std::map<int, int> names;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    names[rim[i]] = static_cast<int>(i);
  }
  for (const int face : near) {
    Eigen::Vector3i renamed;
    for (int k = 0; k < 3; ++k) {
      const int vertex = site.surface.mesh.faces[static_cast<std::size_t>(face)][k];
      const auto [entry, is_new] = names.emplace(vertex, static_cast<int>(patch.points.size()));
      if (is_new) {
        patch.points.push_back(site.at(vertex));
      }
      renamed[k] = entry->second;
    }
    patch.faces.push_back(renamed);
  }
  patch.trust.assign(patch.points.size(), 0.0);
  const double usual_sigma_mm = medianSigma(site.surface, names);
  for (const auto& [vertex, name] : names) {
    patch.trust[static_cast<std::size_t>(name)] = trustOf(site.surface, vertex, usual_sigma_mm);
  }
  markInner(patch);
  const auto faired = fairedPoints(patch, site.options.smoothing_edges * edge_mm);
  if (faired.empty()) {
    return false;
  }
  std::copy(faired.begin() + std::ssize(rim),
            faired.begin() + std::ssize(fill.points),
            fill.points.begin() + std::ssize(rim));
  return true;
}

Filling toFilling(const FillMesh& fill, const std::vector<int>& rim) {
  Filling filling{.rim = rim, .faces = fill.faces};
  for (std::size_t i = rim.size(); i < fill.points.size(); ++i) {
    filling.points.push_back(fill.points[i].cast<float>());
  }
  for (const Eigen::Vector3i& f : fill.faces) {
    const auto at = [&](int k) -> const Vector3d& {
      return fill.points[static_cast<std::size_t>(f[k])];
    };
    filling.area_mm2 += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return filling;
}

}  // namespace

NamedTriangle namedTriangle(const TriangleMesh& mesh, int face) {
  NamedTriangle t;
  t.names = mesh.faces[static_cast<std::size_t>(face)];
  for (int k = 0; k < 3; ++k) {
    t.corners[static_cast<std::size_t>(k)] =
        mesh.vertices[static_cast<std::size_t>(t.names[k])].cast<double>();
  }
  return t;
}

std::vector<NamedTriangle> namedTriangles(const HoleSite& site,
                                          const Filling& filling,
                                          int first_name) {
  const int rim_size = static_cast<int>(filling.rim.size());
  std::vector<NamedTriangle> triangles(filling.faces.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int local = filling.faces[i][k];
      const bool on_rim = local < rim_size;
      const int vertex = on_rim ? filling.rim[static_cast<std::size_t>(local)] : -1;
      triangles[i].names[k] = on_rim ? vertex : first_name + local - rim_size;
      triangles[i].corners[static_cast<std::size_t>(k)] =
          on_rim ? site.at(vertex)
                 : filling.points[static_cast<std::size_t>(local - rim_size)].cast<double>();
    }
  }
  return triangles;
}

Eigen::AlignedBox3f boxOf(const std::vector<NamedTriangle>& triangles) {
  Eigen::AlignedBox3f box;
  for (const NamedTriangle& t : triangles) {
    for (const Vector3d& p : t.corners) {
      box.extend(p.cast<float>());
    }
  }
  return box;
}

namespace {

/// Small enough, and it touches the surface in its rim alone.
bool isClean(const HoleSite& site, const Filling& filling) {
  if (filling.area_mm2 > site.options.max_area_mm2) {
    return false;
  }
  const int first_name = static_cast<int>(site.surface.mesh.vertices.size());
  const auto triangles = namedTriangles(site, filling, first_name);
  std::vector<NamedTriangle> others;
  for (const int face : site.grid.facesIn(boxOf(triangles))) {
    others.push_back(namedTriangle(site.surface.mesh, face));
  }
  return !crosses(triangles, others);
}

}  // namespace

std::optional<Filling> fillHole(const HoleSite& site, const BorderLoop& loop) {
  const std::size_t count = loop.vertices.size();
  std::vector<int> rim(loop.vertices.rbegin(), loop.vertices.rend());
  std::vector<Vector3d> points;
  std::vector<Vector3d> opposite;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(site.at(rim[i]));
    // Edge rim[i] to rim[i + 1] is the loop's edge from rim[i + 1].
    opposite.push_back(site.at(loop.opposite[(2 * count - 2 - i) % count]));
  }
  double edge_mm = typicalEdge(site, facesNear(site, rim, 0.0));
  constexpr double kReach_edges = 4.0;
  const auto near = facesNear(site, rim, kReach_edges * edge_mm);
  edge_mm = typicalEdge(site, near);
  for (const FillStart start : {FillStart::Triangulation, FillStart::Fan}) {
    const auto flat = meshHole(points, opposite, edge_mm, start);
    if (!flat) {
      continue;
    }
    FillMesh smooth = *flat;
    if (fair(site, near, edge_mm, rim, smooth)) {
      Filling filling = toFilling(smooth, rim);
      if (isClean(site, filling)) {
        return filling;
      }
    }
    // In a hole of a few edges' width, among others on a noisy surface, flat will do.
    constexpr double kFlat_edges2 = 10.0;
    Filling filling = toFilling(*flat, rim);
    if (filling.area_mm2 < kFlat_edges2 * edge_mm * edge_mm && isClean(site, filling)) {
      return filling;
    }
  }
  return std::nullopt;
}

}  // namespace tarsus
