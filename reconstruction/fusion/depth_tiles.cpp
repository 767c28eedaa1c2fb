#include "reconstruction/fusion/depth_tiles.h"

#include <cmath>

namespace tarsus {

DepthTiles::DepthTiles(const DepthPlanes& planes, float band_mm)
    : intrinsics_(planes.intrinsics),
      columns_((intrinsics_.width + kTile_px - 1) / kTile_px),
      rows_((intrinsics_.height + kTile_px - 1) / kTile_px),
      tiles_(static_cast<std::size_t>(columns_ * rows_)) {
  const auto pixel_rad = static_cast<float>(1.0 / std::min(intrinsics_.fx_px, intrinsics_.fy_px));
  for (int v = 0; v < intrinsics_.height; ++v) {
    Range* const row = tiles_.data() + (v / kTile_px) * columns_;
    for (int u = 0; u < intrinsics_.width; ++u) {
      const std::size_t i = planes.index(u, v);
      if (planes.quality[i] > 0.0F) {
        Range& tile = row[u / kTile_px];
        // A band across an oblique plane is longer along the optical axis, and the plane itself
        // rises within its pixel.
        const float reach = (band_mm + planes.depth_mm[i] * pixel_rad) / planes.quality[i];
        tile.nearest_mm = std::min(tile.nearest_mm, planes.depth_mm[i] - reach);
        tile.farthest_mm = std::max(tile.farthest_mm, planes.depth_mm[i] + reach);
      }
    }
  }
}

bool DepthTiles::mayConcern(const Eigen::Vector3f& center_camera, float radius_mm) const {
  const float nearest = center_camera.z() - radius_mm;
  if (nearest <= 1.0F) {
    return center_camera.z() + radius_mm > 1.0F;
  }
  const auto fx = static_cast<float>(intrinsics_.fx_px);
  const auto fy = static_cast<float>(intrinsics_.fy_px);
  const float u =
      fx * center_camera.x() / center_camera.z() + static_cast<float>(intrinsics_.cx_px);
  const float v =
      fy * center_camera.y() / center_camera.z() + static_cast<float>(intrinsics_.cy_px);
  // The outline of a ball off the axis is longer than f r / (z - r) says by the ray's obliquity,
  // which is below 1.3 in the corner of a 70 degree view.
  const float reach = 1.3F * std::max(fx, fy) * radius_mm / nearest + 1.0F;
  const auto tileOf = [](float pixel) {
    return static_cast<int>(std::floor(pixel / static_cast<float>(kTile_px)));
  };
  const int first_column = std::max(0, tileOf(u - reach));
  const int last_column = std::min(columns_ - 1, tileOf(u + reach));
  const int last_row = std::min(rows_ - 1, tileOf(v + reach));
  for (int row = std::max(0, tileOf(v - reach)); row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const Range& tile = tiles_[static_cast<std::size_t>(row * columns_ + column)];
      if (nearest <= tile.farthest_mm && center_camera.z() + radius_mm >= tile.nearest_mm) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace tarsus
