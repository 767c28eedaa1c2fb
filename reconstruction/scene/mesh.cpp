#include "reconstruction/scene/mesh.h"

#include "reconstruction/base/sha256.h"

#include <Eigen/Geometry>

#include <span>

namespace tarsus {
namespace {

template <typename T>
void add(Sha256& sum, const std::vector<T>& values) {
  const std::uint64_t count = values.size();
  sum.update(std::as_bytes(std::span(&count, 1)));
  sum.update(std::as_bytes(std::span(values)));
}

}  // namespace

Eigen::Vector3d positionOf(const TriangleMesh& mesh, const SurfacePoint& point) {
  const Eigen::Vector3i& face = mesh.faces.at(point.face);
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    position +=
        point.barycentric[k] * mesh.vertices[static_cast<std::size_t>(face[k])].cast<double>();
  }
  return position;
}

Eigen::Vector3d faceNormal(const TriangleMesh& mesh, int face) {
  const Eigen::Vector3i& f = mesh.faces.at(static_cast<std::size_t>(face));
  const Eigen::Vector3d a = mesh.vertices[static_cast<std::size_t>(f[0])].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[static_cast<std::size_t>(f[1])].cast<double>();
  const Eigen::Vector3d c = mesh.vertices[static_cast<std::size_t>(f[2])].cast<double>();
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double length = normal.norm();
  return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero().eval();
}

std::vector<Eigen::Vector3f> vertexNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const Eigen::Vector3i& f : mesh.faces) {
    const auto& a = mesh.vertices[static_cast<std::size_t>(f[0])];
    const auto& b = mesh.vertices[static_cast<std::size_t>(f[1])];
    const auto& c = mesh.vertices[static_cast<std::size_t>(f[2])];
    const Eigen::Vector3f twice_area = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) {
      normals[static_cast<std::size_t>(f[k])] += twice_area;
    }
  }
  for (Eigen::Vector3f& normal : normals) {
    const float length = normal.norm();
    if (length > 0.0F) {
      normal /= length;
    }
  }
  return normals;
}

CompactedMesh compact(const TriangleMesh& mesh) {
  std::vector<int> new_index(mesh.vertices.size(), -1);
  for (const Eigen::Vector3i& f : mesh.faces) {
    for (int k = 0; k < 3; ++k) {
      new_index[static_cast<std::size_t>(f[k])] = 0;
    }
  }
  CompactedMesh result;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (new_index[i] < 0) {
      continue;
    }
    new_index[i] = static_cast<int>(result.kept.size());
    result.kept.push_back(static_cast<int>(i));
    result.mesh.vertices.push_back(mesh.vertices[i]);
    if (!mesh.normals.empty()) {
      result.mesh.normals.push_back(mesh.normals[i]);
    }
  }
  result.mesh.faces.reserve(mesh.faces.size());
  for (const Eigen::Vector3i& f : mesh.faces) {
    result.mesh.faces.emplace_back(new_index[static_cast<std::size_t>(f[0])],
                                   new_index[static_cast<std::size_t>(f[1])],
                                   new_index[static_cast<std::size_t>(f[2])]);
  }
  return result;
}

TexturedMesh withHash(TexturedMesh mesh) {
  Sha256 sum;
  add(sum, mesh.mesh.vertices);
  add(sum, mesh.mesh.faces);
  add(sum, mesh.colors);
  mesh.sha256 = sum.hex();
  return mesh;
}

}  // namespace tarsus
