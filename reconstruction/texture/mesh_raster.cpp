#include "reconstruction/texture/mesh_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

constexpr float kMinDepth_mm = 10.0F;
/// Pixels on an edge that two faces share belong to both, whatever the rounding.
constexpr float kEdgeTolerance = 1e-4F;

struct Corner {
  float u = 0.0F;
  float v = 0.0F;
  float inverse_z = 0.0F;  ///< 0: behind the camera
};

std::vector<Corner> project(const TriangleMesh& mesh,
                            const Intrinsics& camera,
                            const Eigen::Isometry3f& camera_from_mesh) {
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px);
  const auto cy = static_cast<float>(camera.cy_px);
  std::vector<Corner> corners(mesh.vertices.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3f p = camera_from_mesh * mesh.vertices[i];
    if (p.z() >= kMinDepth_mm) {
      const float inverse_z = 1.0F / p.z();
      corners[i] = {fx * p.x() * inverse_z + cx, fy * p.y() * inverse_z + cy, inverse_z};
    }
  }
  return corners;
}

struct PixelRange {
  int first;
  int last;
};

PixelRange pixelsBetween(float a, float b, float c, int size) {
  const float low = std::min({a, b, c}) - kEdgeTolerance;
  const float high = std::max({a, b, c}) + kEdgeTolerance;
  if (!(high >= 0.0F) || !(low <= static_cast<float>(size - 1))) {
    return {0, -1};
  }
  return {static_cast<int>(std::ceil(std::max(low, 0.0F))),
          static_cast<int>(std::floor(std::min(high, static_cast<float>(size - 1))))};
}

/// Draws one face where it is nearer than what is there.
void draw(const std::array<Corner, 3>& corners, int face, SurfaceImage& image) {
  const auto& [a, b, c] = corners;
  const PixelRange columns = pixelsBetween(a.u, b.u, c.u, image.face.width());
  const PixelRange rows = pixelsBetween(a.v, b.v, c.v, image.face.height());
  if (columns.first > columns.last || rows.first > rows.last) {
    return;
  }
  const float area = (b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v);
  if (area == 0.0F) {
    return;
  }
  const float inverse_area = 1.0F / area;
  for (int row = rows.first; row <= rows.last; ++row) {
    const auto v = static_cast<float>(row);
    for (int column = columns.first; column <= columns.last; ++column) {
      const auto u = static_cast<float>(column);
      const float at_b = ((u - a.u) * (c.v - a.v) - (c.u - a.u) * (v - a.v)) * inverse_area;
      const float at_c = ((b.u - a.u) * (v - a.v) - (u - a.u) * (b.v - a.v)) * inverse_area;
      const float at_a = 1.0F - at_b - at_c;
      if (std::min({at_a, at_b, at_c}) < -kEdgeTolerance) {
        continue;
      }
      const float depth_mm = 1.0F / (at_a * a.inverse_z + at_b * b.inverse_z + at_c * c.inverse_z);
      float& nearest = image.depth_mm.at(column, row);
      if (nearest == 0.0F || depth_mm < nearest) {
        nearest = depth_mm;
        image.face.at(column, row) = face;
      }
    }
  }
}

}  // namespace

SurfaceImage rasterize(const TriangleMesh& mesh,
                       const Intrinsics& camera,
                       const Eigen::Isometry3f& camera_from_mesh) {
  SurfaceImage image{DepthImage(camera.width, camera.height),
                     Image<int>(camera.width, camera.height)};
  std::ranges::fill(image.face.pixels(), -1);
  const std::vector<Corner> corners = project(mesh, camera, camera_from_mesh);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Eigen::Vector3i& f = mesh.faces[i];
    const std::array<Corner, 3> face{corners[static_cast<std::size_t>(f[0])],
                                     corners[static_cast<std::size_t>(f[1])],
                                     corners[static_cast<std::size_t>(f[2])]};
    if (face[0].inverse_z > 0.0F && face[1].inverse_z > 0.0F && face[2].inverse_z > 0.0F) {
      draw(face, static_cast<int>(i), image);
    }
  }
  return image;
}

}  // namespace tarsus
