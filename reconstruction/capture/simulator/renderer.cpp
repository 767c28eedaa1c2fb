#include "reconstruction/capture/simulator/renderer.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

TexturedMesh joined(const SimulatedScene& scene) {
  TexturedMesh all;
  all.mesh.vertices = scene.foot.mesh.vertices;
  all.mesh.faces = scene.foot.mesh.faces;
  all.colors = scene.foot.colors;
  const int first = static_cast<int>(all.mesh.vertices.size());
  const TexturedMesh& more = scene.surroundings;
  all.mesh.vertices.insert(
      all.mesh.vertices.end(), more.mesh.vertices.begin(), more.mesh.vertices.end());
  all.colors.insert(all.colors.end(), more.colors.begin(), more.colors.end());
  for (const Vector3i& f : more.mesh.faces) {
    all.mesh.faces.emplace_back(f + Vector3i::Constant(first));
  }
  return all;
}

/// Rays are cast by tiles of this many pixels squared: neighbours in both directions meet the same
/// faces, which is much faster than rows.
constexpr int kTile = 4;

std::vector<Vector3f> faceNormals(const TriangleMesh& mesh) {
  std::vector<Vector3f> normals(mesh.faces.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    normals[i] = faceNormal(mesh, static_cast<int>(i)).cast<float>();
  }
  return normals;
}

Vector3f toVector(const Rgb8& c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const SimulatedScene> scene)
    : everything_(joined(*scene)),
      face_normals_(faceNormals(everything_.mesh)),
      index_(everything_.mesh) {}

IdealView Renderer::render(const Intrinsics& camera, const RigidTransform& scan_from_camera) const {
  IdealView view{.depth_mm = DepthImage(camera.width, camera.height),
                 .incidence_cos = Image<float>(camera.width, camera.height),
                 .brightness = Image<float>(camera.width, camera.height),
                 .color = Image<Vector3f>(camera.width, camera.height)};
  parallelFor((camera.height + kTile - 1) / kTile,
              [&](int row) { renderTileRow(camera, scan_from_camera, row * kTile, view); });
  return view;
}

void Renderer::renderTileRow(const Intrinsics& camera,
                             const RigidTransform& scan_from_camera,
                             int first_v,
                             IdealView& view) const {
  const int tiles = (camera.width + kTile - 1) / kTile;
  const auto count = static_cast<std::size_t>(tiles * kTile * kTile);
  const auto pixel = [first_v](std::size_t i) {
    const int k = static_cast<int>(i);
    return Eigen::Vector2i(k / (kTile * kTile) * kTile + k % kTile, first_v + k / kTile % kTile);
  };
  std::vector<Vector3f> directions(count);
  std::vector<MeshIndex::RayHit> hits(count);
  const Eigen::Matrix3d rotation = scan_from_camera.linear();
  for (std::size_t i = 0; i < count; ++i) {
    directions[i] = (rotation * camera.ray(pixel(i).x(), pixel(i).y())).cast<float>();
  }
  index_.castRays(scan_from_camera.translation().cast<float>(), directions, hits);
  for (std::size_t i = 0; i < count; ++i) {
    const int u = pixel(i).x();
    const int v = pixel(i).y();
    if (u >= camera.width || v >= camera.height) {
      continue;
    }
    if (hits[i].face < 0) {
      view.color.at(u, v) = Vector3f(24.0F, 26.0F, 28.0F);
      continue;
    }
    const auto face = static_cast<std::size_t>(hits[i].face);
    const Vector3i& f = everything_.mesh.faces[face];
    const auto paint = [&](int k) {
      return toVector(everything_.colors[static_cast<std::size_t>(f[k])]);
    };
    const Vector3f& b = hits[i].barycentric;
    const Vector3f color = b.x() * paint(0) + b.y() * paint(1) + b.z() * paint(2);
    // The ray has z = 1 in the camera, so its length to the hit is z; MeshIndex computes it in
    // double from the triangle itself.
    view.depth_mm.at(u, v) = hits[i].distance;
    view.incidence_cos.at(u, v) =
        std::abs(face_normals_[face].dot(directions[i])) / directions[i].norm();
    view.brightness.at(u, v) = color.maxCoeff() / 255.0F;
    view.color.at(u, v) = color;
  }
}

}  // namespace tarsus
