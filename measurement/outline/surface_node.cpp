#include "measurement/outline/surface_patch.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

int indexOf(const std::vector<int>& ascending, std::uint32_t value) {
  const int wanted = static_cast<int>(value);
  const auto it = std::lower_bound(ascending.begin(), ascending.end(), wanted);
  return it != ascending.end() && *it == wanted ? static_cast<int>(it - ascending.begin()) : -1;
}

/// Takes the zeros among the coordinates as they are: what was snapped once stays where it is.
SurfaceNode asStored(const SurfacePatch& patch, int face, const Eigen::Vector3d& barycentric) {
  const auto& f = patch.faces[face];
  SurfaceNode node;
  node.face = face;
  node.barycentric = barycentric;
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3;
    const int b = (k + 2) % 3;
    if (barycentric[a] <= 0.0 && barycentric[b] <= 0.0) {
      return vertexNode(patch, f[k]);
    }
    if (barycentric[k] <= 0.0 && barycentric[a] > 0.0 && barycentric[b] > 0.0) {
      node.v0 = std::min(f[a], f[b]);
      node.v1 = std::max(f[a], f[b]);
      node.t = barycentric[f[a] < f[b] ? b : a];
    }
  }
  return node;
}

}  // namespace

SurfaceNode vertexNode(const SurfacePatch& patch, int vertex) {
  SurfaceNode node;
  node.v0 = vertex;
  node.face = patch.starOf(vertex).empty() ? -1 : patch.starOf(vertex).front();
  if (node.face >= 0) {
    node.barycentric[patch.cornerOf(node.face, vertex)] = 1.0;
  }
  return node;
}

SurfaceNode edgeNode(const SurfacePatch& patch, int face, int corner, double t) {
  const int a = patch.faces[face][corner];
  const int b = patch.faces[face][(corner + 1) % 3];
  if (t < kSnapFraction) {
    return vertexNode(patch, a);
  }
  if (t > 1.0 - kSnapFraction) {
    return vertexNode(patch, b);
  }
  SurfaceNode node;
  node.face = face;
  node.v0 = std::min(a, b);
  node.v1 = std::max(a, b);
  node.t = a < b ? t : 1.0 - t;
  node.barycentric[patch.cornerOf(face, node.v0)] = 1.0 - node.t;
  node.barycentric[patch.cornerOf(face, node.v1)] = node.t;
  return node;
}

SurfaceNode faceNode(const SurfacePatch& patch, int face, const Eigen::Vector3d& barycentric) {
  Eigen::Vector3d b = barycentric.cwiseMax(0.0);
  b /= b.sum();
  for (int k = 0; k < 3; ++k) {
    if (b[k] > 1.0 - kSnapFraction) {
      return vertexNode(patch, patch.faces[face][k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (b[(k + 2) % 3] < kSnapFraction) {
      return edgeNode(patch, face, k, b[(k + 1) % 3] / (b[k] + b[(k + 1) % 3]));
    }
  }
  SurfaceNode node;
  node.face = face;
  node.barycentric = b;
  return node;
}

Eigen::Vector3d positionOf(const SurfacePatch& patch, const SurfaceNode& node) {
  if (node.onVertex()) {
    return patch.vertices[node.v0];
  }
  if (node.onEdge()) {
    return (1.0 - node.t) * patch.vertices[node.v0] + node.t * patch.vertices[node.v1];
  }
  const auto& f = patch.faces[node.face];
  return node.barycentric[0] * patch.vertices[f[0]] + node.barycentric[1] * patch.vertices[f[1]] +
         node.barycentric[2] * patch.vertices[f[2]];
}

bool samePlace(const SurfaceNode& a, const SurfaceNode& b) {
  if (a.v0 != b.v0 || a.v1 != b.v1) {
    return false;
  }
  if (a.onVertex()) {
    return true;
  }
  if (a.onEdge()) {
    return std::abs(a.t - b.t) < kSnapFraction;
  }
  return a.face == b.face && (a.barycentric - b.barycentric).norm() < kSnapFraction;
}

std::vector<int> facesOf(const SurfacePatch& patch, const SurfaceNode& node) {
  if (node.onVertex()) {
    const auto star = patch.starOf(node.v0);
    return {star.begin(), star.end()};
  }
  if (node.insideFace()) {
    return {node.face};
  }
  std::vector<int> faces;
  for (const int face : patch.starOf(node.v0)) {
    if (patch.cornerOf(face, node.v1) >= 0) {
      faces.push_back(face);
    }
  }
  return faces;
}

std::vector<int> commonFaces(const SurfacePatch& patch,
                             const SurfaceNode& a,
                             const SurfaceNode& b) {
  std::vector<int> faces = facesOf(patch, a);
  const std::vector<int> others = facesOf(patch, b);
  std::erase_if(faces, [&](int face) {
    return std::find(others.begin(), others.end(), face) == others.end();
  });
  return faces;
}

Eigen::Vector3d barycentricIn(const SurfacePatch& patch, int face, const SurfaceNode& node) {
  if (node.insideFace()) {
    return node.barycentric;
  }
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  b[patch.cornerOf(face, node.v0)] = node.onEdge() ? 1.0 - node.t : 1.0;
  if (node.onEdge()) {
    b[patch.cornerOf(face, node.v1)] = node.t;
  }
  return b;
}

SurfaceNode nodeOf(const SurfacePatch& patch, const SurfacePoint& point) {
  const int face = indexOf(patch.mesh_face, point.face);
  if (face >= 0) {
    return asStored(patch, face, point.barycentric);
  }
  const int dropped = indexOf(patch.dropped_mesh_face, point.face);
  if (dropped >= 0) {
    // A collapsed face is a point or a line; its nearest corner stands for it.
    Eigen::Index corner = 0;
    point.barycentric.maxCoeff(&corner);
    return vertexNode(patch, patch.dropped_face[dropped][corner]);
  }
  return {};
}

SurfacePoint meshPointOf(const SurfacePatch& patch, const SurfaceNode& node) {
  return {.face = static_cast<std::uint32_t>(patch.mesh_face[node.face]),
          .barycentric = barycentricIn(patch, node.face, node)};
}

}  // namespace tarsus
