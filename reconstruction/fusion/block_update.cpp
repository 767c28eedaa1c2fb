#include "reconstruction/fusion/block_update.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {

BlockUpdate::BlockUpdate(const RgbdCamera& camera,
                         const DepthPlanes& planes,
                         const ColorImage* color,
                         const RigidTransform& camera_from_scan,
                         const TsdfOptions& options)
    : camera_(camera),
      planes_(planes),
      color_(color),
      rotation_(camera_from_scan.linear().cast<float>()),
      translation_(camera_from_scan.translation().cast<float>()),
      color_rotation_(camera.color_from_depth.linear().cast<float>()),
      color_translation_(camera.color_from_depth.translation().cast<float>()),
      voxel_size_mm_(static_cast<float>(options.voxel_size_mm)),
      delta_mm_(static_cast<float>(options.weighting.delta_mm)),
      color_band_mm_(2.0F * voxel_size_mm_),
      weight_scale_(static_cast<float>(kWeightSteps) / delta_mm_) {
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    weights_[i] = static_cast<float>(options.weighting.weight(
        options.weighting.delta_mm * static_cast<double>(i) / kWeightSteps));
  }
}

void BlockUpdate::apply(BlockGrid& grid, int block) const {
  const Eigen::Vector3f origin =
      grid.coordinates(block).cast<float>() * (voxel_size_mm_ * static_cast<float>(kBlockSide));
  Layer layer;
  for (int k = 0; k < kBlockSide; ++k) {
    const Eigen::Vector3f first(
        origin.x(), origin.y(), origin.z() + voxel_size_mm_ * static_cast<float>(k));
    project(rotation_ * first + translation_, layer);
    fuse(layer, k * kLayer, grid.block(block), color_ != nullptr ? &grid.colors(block) : nullptr);
  }
}

/// @param first  the layer's first voxel in the camera frame [mm]
void BlockUpdate::project(const Eigen::Vector3f& first, Layer& layer) const {
  const Eigen::Vector3f along_x = rotation_.col(0) * voxel_size_mm_;
  const Eigen::Vector3f along_y = rotation_.col(1) * voxel_size_mm_;
  const Intrinsics& k = planes_.intrinsics;
  const auto fx = static_cast<float>(k.fx_px);
  const auto fy = static_cast<float>(k.fy_px);
  // Half a pixel more, so that cutting off decimals gives the nearest pixel.
  const auto cx = static_cast<float>(k.cx_px + 0.5);
  const auto cy = static_cast<float>(k.cy_px + 0.5);
  const auto width = static_cast<float>(k.width);
  const auto height = static_cast<float>(k.height);
  for (int row = 0; row < kBlockSide; ++row) {
    const Eigen::Vector3f start = first + along_y * static_cast<float>(row);
    float* const x = layer.x.data() + row * kBlockSide;
    float* const y = layer.y.data() + row * kBlockSide;
    float* const z = layer.z.data() + row * kBlockSide;
    std::int32_t* const pixel = layer.pixel.data() + row * kBlockSide;
    for (int i = 0; i < kBlockSide; ++i) {
      const auto step = static_cast<float>(i);
      x[i] = start.x() + along_x.x() * step;
      y[i] = start.y() + along_x.y() * step;
      z[i] = start.z() + along_x.z() * step;
      const float inverse = 1.0F / z[i];
      const float u = fx * x[i] * inverse + cx;
      const float v = fy * y[i] * inverse + cy;
      const bool inside = (z[i] > 1.0F) & (u >= 0.0F) & (u < width) & (v >= 0.0F) & (v < height);
      const float safe_u = inside ? u : 0.0F;
      const float safe_v = inside ? v : 0.0F;
      const std::int32_t at =
          static_cast<std::int32_t>(safe_v) * k.width + static_cast<std::int32_t>(safe_u);
      pixel[i] = inside ? at : -1;
    }
  }
}

void BlockUpdate::fuse(const Layer& layer,
                       int first_voxel,
                       VoxelBlock& block,
                       ColorBlock* colors) const {
  for (int i = 0; i < kLayer; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (layer.pixel[at] < 0) {
      continue;
    }
    const auto pixel = static_cast<std::size_t>(layer.pixel[at]);
    const float quality = planes_.quality[pixel];
    if (quality <= 0.0F) {
      continue;
    }
    const DepthPlanes::Plane& plane = planes_.planes[pixel];
    const float distance =
        plane.nx * layer.x[at] + plane.ny * layer.y[at] + plane.nz * layer.z[at] + plane.offset;
    // The plane alone would reach far along an oblique surface: hold the ray to the band as well.
    const float behind = layer.z[at] - planes_.depth_mm[pixel];
    if (!(std::abs(distance) <= delta_mm_) || std::abs(behind) > 3.0F * delta_mm_) {
      continue;
    }
    const float weight = quality * weightOf(distance);
    const auto voxel = static_cast<std::size_t>(first_voxel + i);
    const float old_weight = block.weight[voxel];
    const float new_weight = old_weight + weight;
    const float old_distance = old_weight > 0.0F ? block.distance_mm[voxel] : distance;
    const float deviation = distance - old_distance;
    const float new_distance = old_distance + deviation * (weight / new_weight);
    block.distance_mm[voxel] = new_distance;
    block.deviation_mm2[voxel] += weight * deviation * (distance - new_distance);
    block.weight[voxel] = new_weight;
    if (block.observations[voxel] < std::numeric_limits<std::uint16_t>::max()) {
      ++block.observations[voxel];
    }
    if (colors != nullptr && std::abs(distance) < color_band_mm_) {
      // Steep views smear colour over many voxels: they count less than for the distance.
      fuseColor(
          {layer.x[at], layer.y[at], layer.z[at]}, quality * quality, first_voxel + i, *colors);
    }
  }
}

void BlockUpdate::fuseColor(const Eigen::Vector3f& p_camera,
                            float weight,
                            int voxel,
                            ColorBlock& colors) const {
  const Eigen::Vector3f p = color_rotation_ * p_camera + color_translation_;
  if (p.z() <= 1.0F) {
    return;
  }
  const Intrinsics& k = camera_.color;
  const float u = static_cast<float>(k.fx_px) * p.x() / p.z() + static_cast<float>(k.cx_px + 0.5);
  const float v = static_cast<float>(k.fy_px) * p.y() / p.z() + static_cast<float>(k.cy_px + 0.5);
  if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(k.width) &&
        v < static_cast<float>(k.height))) {
    return;
  }
  const Rgb8 seen = color_->at(static_cast<int>(u), static_cast<int>(v));
  const auto i = static_cast<std::size_t>(voxel);
  colors.weight[i] += weight;
  const float share = weight / colors.weight[i];
  std::array<float, 3>& rgb = colors.rgb[i];
  rgb[0] += share * (static_cast<float>(seen.r) - rgb[0]);
  rgb[1] += share * (static_cast<float>(seen.g) - rgb[1]);
  rgb[2] += share * (static_cast<float>(seen.b) - rgb[2]);
}

float BlockUpdate::weightOf(float distance_mm) const {
  const auto step = static_cast<std::size_t>(std::abs(distance_mm) * weight_scale_);
  return weights_[std::min(step, weights_.size() - 1)];
}

}  // namespace tarsus
