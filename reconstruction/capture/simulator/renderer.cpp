#include "reconstruction/capture/simulator/renderer.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using Eigen::Vector3d;
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

Vector3f toVector(const Rgb8& c) {
  return {static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b)};
}

}  // namespace

Renderer::Renderer(std::shared_ptr<const SimulatedScene> scene)
    : everything_(joined(*scene)), index_(everything_.mesh) {}

IdealView Renderer::render(const Intrinsics& camera, const RigidTransform& scan_from_camera) const {
  IdealView view{.depth_mm = DepthImage(camera.width, camera.height),
                 .incidence_cos = Image<float>(camera.width, camera.height),
                 .brightness = Image<float>(camera.width, camera.height),
                 .color = Image<Vector3f>(camera.width, camera.height)};
  constexpr int kRowsPerTask = 8;
  parallelFor((camera.height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(camera.height, (task + 1) * kRowsPerTask);
    for (int v = task * kRowsPerTask; v < end; ++v) {
      renderRow(camera, scan_from_camera, v, view);
    }
  });
  return view;
}

void Renderer::renderRow(const Intrinsics& camera,
                         const RigidTransform& scan_from_camera,
                         int v,
                         IdealView& view) const {
  const auto width = static_cast<std::size_t>(camera.width);
  std::vector<Vector3f> directions(width);
  std::vector<MeshIndex::RayHit> hits(width);
  const Eigen::Matrix3d rotation = scan_from_camera.linear();
  const Vector3d origin = scan_from_camera.translation();
  for (std::size_t u = 0; u < width; ++u) {
    directions[u] = (rotation * camera.ray(static_cast<double>(u), v)).cast<float>();
  }
  index_.castRays(origin.cast<float>(), directions, hits);
  for (std::size_t u = 0; u < width; ++u) {
    const int pixel_u = static_cast<int>(u);
    if (hits[u].face < 0) {
      view.color.at(pixel_u, v) = Vector3f(24.0F, 26.0F, 28.0F);
      continue;
    }
    const Vector3i& f = everything_.mesh.faces[static_cast<std::size_t>(hits[u].face)];
    const auto corner = [&](int k) -> Vector3d {
      return everything_.mesh.vertices[static_cast<std::size_t>(f[k])].cast<double>();
    };
    const auto paint = [&](int k) {
      return toVector(everything_.colors[static_cast<std::size_t>(f[k])]);
    };
    // Again in double, from the triangle's plane: the ray caster's distance is single precision.
    const Vector3d a = corner(0);
    const Vector3d normal = (corner(1) - a).cross(corner(2) - a);
    const Vector3d direction = rotation * camera.ray(static_cast<double>(u), v);
    const double facing = normal.dot(direction);
    const double z_mm = normal.dot(a - origin) / facing;
    const Vector3f& b = hits[u].barycentric;
    const Vector3f color = b.x() * paint(0) + b.y() * paint(1) + b.z() * paint(2);
    view.depth_mm.at(pixel_u, v) = static_cast<float>(z_mm);
    view.incidence_cos.at(pixel_u, v) =
        static_cast<float>(std::abs(facing) / (normal.norm() * direction.norm()));
    view.brightness.at(pixel_u, v) = color.maxCoeff() / 255.0F;
    view.color.at(pixel_u, v) = color;
  }
}

}  // namespace tarsus
