#include "measurement/outline/surface_patch.h"

#include "measurement/outline/segment.h"
#include "measurement/outline/union_find.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tarsus {
namespace {

/// Vertices closer than this along an edge are one vertex: below the resolution of a float at
/// 100 mm.
constexpr double kWeldLength_mm = 1e-5;

/// Gives coincident vertices one index; compacts vertices, drops faces that collapse.
void weld(SurfacePatch& patch) {
  const auto count = patch.vertices.size();
  UnionFind sets(count);
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const auto& p = patch.vertices[i];
    return std::array{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  for (std::size_t i = 1; i < count; ++i) {
    if (patch.vertices[order[i]] == patch.vertices[order[i - 1]]) {
      sets.join(order[i], order[i - 1]);
    }
  }
  for (const auto& f : patch.faces) {
    for (int k = 0; k < 3; ++k) {
      const int a = f[k];
      const int b = f[(k + 1) % 3];
      if ((patch.vertices[a] - patch.vertices[b]).norm() < kWeldLength_mm) {
        sets.join(a, b);
      }
    }
  }
  std::vector<int> new_index(count, -1);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int root = sets.root(static_cast<int>(i));
    if (root == static_cast<int>(i)) {
      new_index[i] = static_cast<int>(kept);
      patch.vertices[kept] = patch.vertices[i];
      patch.mesh_vertex[kept] = patch.mesh_vertex[i];
      ++kept;
    } else {
      new_index[i] = new_index[root];
    }
  }
  patch.vertices.resize(kept);
  patch.mesh_vertex.resize(kept);
  std::size_t kept_faces = 0;
  for (std::size_t i = 0; i < patch.faces.size(); ++i) {
    std::array<int, 3> f = patch.faces[i];
    for (int& v : f) {
      v = new_index[v];
    }
    if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) {
      patch.dropped_face.push_back(f);
      patch.dropped_mesh_face.push_back(patch.mesh_face[i]);
      continue;
    }
    patch.faces[kept_faces] = f;
    patch.mesh_face[kept_faces] = patch.mesh_face[i];
    ++kept_faces;
  }
  patch.faces.resize(kept_faces);
  patch.mesh_face.resize(kept_faces);
}

void findStars(SurfacePatch& patch) {
  patch.star_begin.assign(patch.vertices.size() + 1, 0);
  for (const auto& f : patch.faces) {
    for (const int v : f) {
      ++patch.star_begin[v + 1];
    }
  }
  std::partial_sum(patch.star_begin.begin(), patch.star_begin.end(), patch.star_begin.begin());
  patch.star.resize(patch.faces.size() * 3);
  std::vector<int> next(patch.star_begin.begin(), patch.star_begin.end() - 1);
  for (int i = 0; i < static_cast<int>(patch.faces.size()); ++i) {
    for (const int v : patch.faces[i]) {
      patch.star[next[v]++] = i;
    }
  }
}

/// Two faces are neighbours where they alone share an edge and run along it in opposite senses;
/// anything else counts as a border.
int neighborAcross(const SurfacePatch& patch, int face, int corner) {
  const int a = patch.faces[face][corner];
  const int b = patch.faces[face][(corner + 1) % 3];
  int other = -1;
  for (const int candidate : patch.starOf(a)) {
    if (candidate != face && patch.cornerOf(candidate, b) >= 0) {
      if (other >= 0) {
        return -1;
      }
      other = candidate;
    }
  }
  return other >= 0 && patch.faces[other][(patch.cornerOf(other, b) + 1) % 3] == a ? other : -1;
}

void findNeighbors(SurfacePatch& patch) {
  patch.neighbors.assign(patch.faces.size(), {-1, -1, -1});
  for (int i = 0; i < static_cast<int>(patch.faces.size()); ++i) {
    for (int k = 0; k < 3; ++k) {
      patch.neighbors[i][k] = neighborAcross(patch, i, k);
    }
  }
}

/// A border edge belongs to the model where an end lies inside the ball: the ball's own rim runs
/// through faces whose outer vertices lie outside.
void findBorders(SurfacePatch& patch, const std::vector<char>& inside_ball, bool whole) {
  patch.border.assign(patch.vertices.size(), PatchBorder::None);
  for (std::size_t i = 0; i < patch.faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (patch.neighbors[i][k] >= 0) {
        continue;
      }
      const int a = patch.faces[i][k];
      const int b = patch.faces[i][(k + 1) % 3];
      const bool model =
          whole || inside_ball[patch.mesh_vertex[a]] != 0 || inside_ball[patch.mesh_vertex[b]] != 0;
      if (!model) {
        patch.clear_radius_mm = std::min(
            patch.clear_radius_mm,
            nearestOnSegment(patch.center_mm, patch.vertices[a], patch.vertices[b]).distance);
      }
      for (const int v : {a, b}) {
        if (model) {
          patch.border[v] = PatchBorder::Model;
        } else if (patch.border[v] == PatchBorder::None) {
          patch.border[v] = PatchBorder::Rim;
        }
      }
    }
  }
}

}  // namespace

SurfacePatch extractPatch(const TriangleMesh& mesh,
                          const Eigen::Vector3d& center_mm,
                          double radius_mm) {
  std::vector<char> inside(mesh.vertices.size(), 0);
  const Eigen::Vector3f center = center_mm.cast<float>();
  const auto radius2 = static_cast<float>(radius_mm * radius_mm);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    inside[i] = (mesh.vertices[i] - center).squaredNorm() <= radius2 ? 1 : 0;
  }
  SurfacePatch patch;
  patch.center_mm = center_mm;
  std::vector<int> local(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Eigen::Vector3i& f = mesh.faces[i];
    if (inside[f[0]] == 0 && inside[f[1]] == 0 && inside[f[2]] == 0) {
      continue;
    }
    patch.faces.push_back({f[0], f[1], f[2]});
    patch.mesh_face.push_back(static_cast<int>(i));
    local[f[0]] = local[f[1]] = local[f[2]] = 0;
  }
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (local[i] == 0) {
      local[i] = static_cast<int>(patch.vertices.size());
      patch.vertices.emplace_back(mesh.vertices[i].cast<double>());
      patch.mesh_vertex.push_back(static_cast<int>(i));
    }
  }
  for (auto& face : patch.faces) {
    face = {local[face[0]], local[face[1]], local[face[2]]};
  }
  const bool whole = patch.faces.size() == mesh.faces.size();
  weld(patch);
  findStars(patch);
  findNeighbors(patch);
  findBorders(patch, inside, whole);
  return patch;
}

}  // namespace tarsus
