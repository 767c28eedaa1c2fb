#include "reconstruction/fusion/block_update.h"

#include "reconstruction/base/vector_code.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

/// What the inner loops need, in plain arrays and numbers.
struct FrameArrays {
  const float* nx;
  const float* ny;
  const float* nz;
  const float* offset_mm;
  const float* quality;
  float fx, fy, cx, cy;  ///< cx, cy half a pixel more: cutting off decimals gives the nearest pixel
  float width, height;
  std::int32_t row_length;
  std::int32_t outside;  ///< entry for points outside the image
};

/// Camera coordinates of a block's first voxel and the steps to the next along each axis.
struct BlockFrame {
  std::array<float, 3> first, along_x, along_y, along_z;
};

struct WeightNumbers {
  float epsilon_mm, delta_mm, sigma_per_mm2;
};

/// Signed distance and quality of each voxel of a block; quality 0 and a distance beyond the band
/// where the frame says nothing.
struct Observed {
  std::array<float, kBlockVoxels> distance_mm;
  std::array<float, kBlockVoxels> quality;
};

TARSUS_VECTOR_CODE void observe(const FrameArrays& frame_arrays,
                                const BlockFrame& block,
                                Observed& observed) {
  const FrameArrays f = frame_arrays;
  const BlockFrame b = block;
  for (int row = 0; row < kBlockSide * kBlockSide; ++row) {
    const auto j = static_cast<float>(row & 7);
    const auto k = static_cast<float>(row >> 3);
    const float x0 = b.first[0] + b.along_y[0] * j + b.along_z[0] * k;
    const float y0 = b.first[1] + b.along_y[1] * j + b.along_z[1] * k;
    const float z0 = b.first[2] + b.along_y[2] * j + b.along_z[2] * k;
    float* const distance = observed.distance_mm.data() + row * kBlockSide;
    float* const quality = observed.quality.data() + row * kBlockSide;
#pragma GCC ivdep
    for (int i = 0; i < kBlockSide; ++i) {
      const auto step = static_cast<float>(i);
      const float x = x0 + b.along_x[0] * step;
      const float y = y0 + b.along_x[1] * step;
      const float z = z0 + b.along_x[2] * step;
      const float inverse = 1.0F / z;
      const float u = f.fx * x * inverse + f.cx;
      const float v = f.fy * y * inverse + f.cy;
      const bool inside = (z > 1.0F) & (u >= 0.0F) & (u < f.width) & (v >= 0.0F) & (v < f.height);
      const auto column = static_cast<std::int32_t>(inside ? u : 0.0F);
      const auto line = static_cast<std::int32_t>(inside ? v : 0.0F);
      const std::int32_t pixel = inside ? line * f.row_length + column : f.outside;
      distance[i] = f.nx[pixel] * x + f.ny[pixel] * y + f.nz[pixel] * z + f.offset_mm[pixel];
      quality[i] = f.quality[pixel];
    }
  }
}

/// exp(-a) for a >= 0 to 1e-3 of its value up to a = 5: the same bits everywhere, and vectorised.
inline float fallOff(float a) {
  const float b = std::min(a * (1.0F / 16.0F), 1.5F);
  float power = 1.0F - b * (1.0F - b * (0.5F - b * (1.0F / 6.0F)));
  power *= power;
  power *= power;
  power *= power;
  return power * power;
}

/// Running weighted mean and deviation (West 1979) where the frame speaks; the rest unchanged.
TARSUS_VECTOR_CODE void average(const Observed& observed,
                                const WeightNumbers& numbers,
                                VoxelBlock& block) {
  const WeightNumbers n = numbers;
#pragma GCC ivdep
  for (std::size_t i = 0; i < kBlockVoxels; ++i) {
    const float distance = observed.distance_mm[i];
    const float off = std::abs(distance);
    const float beyond = std::max(off - n.epsilon_mm, 0.0F);
    const bool speaks = (off <= n.delta_mm) & (observed.quality[i] > 0.0F);
    const float weight = observed.quality[i] * fallOff(n.sigma_per_mm2 * beyond * beyond);
    const float old_weight = block.weight[i];
    const float old_distance = old_weight > 0.0F ? block.distance_mm[i] : distance;
    const float new_weight = old_weight + weight;
    const float deviation = distance - old_distance;
    const float new_distance = old_distance + deviation * (weight / std::max(new_weight, 1e-12F));
    const float squares = block.deviation_mm2[i] + weight * deviation * (distance - new_distance);
    block.distance_mm[i] = speaks ? new_distance : block.distance_mm[i];
    block.deviation_mm2[i] = speaks ? squares : block.deviation_mm2[i];
    block.weight[i] = speaks ? new_weight : old_weight;
  }
}

TARSUS_VECTOR_CODE void count(const Observed& observed, float delta_mm, VoxelBlock& block) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < kBlockVoxels; ++i) {
    const bool speaks =
        (std::abs(observed.distance_mm[i]) <= delta_mm) & (observed.quality[i] > 0.0F);
    const std::int32_t seen = block.observations[i] + (speaks ? 1 : 0);
    block.observations[i] = static_cast<std::uint16_t>(std::min(seen, 65535));
  }
}

bool anySpeaks(const Observed& observed, float delta_mm) {
  return std::any_of(observed.distance_mm.begin(), observed.distance_mm.end(), [&](float d) {
    return std::abs(d) <= delta_mm;
  });
}

}  // namespace

BlockUpdate::BlockUpdate(const RgbdCamera& camera,
                         const DepthPlanes& planes,
                         const ColorImage* color,
                         const RigidTransform& camera_from_scan,
                         const TsdfOptions& options)
    : camera_(camera),
      planes_(planes),
      color_(color),
      weighting_(options.weighting),
      rotation_(camera_from_scan.linear().cast<float>()),
      translation_(camera_from_scan.translation().cast<float>()),
      color_from_scan_rotation_(
          (camera.color_from_depth * camera_from_scan).linear().cast<float>()),
      color_from_scan_translation_(
          (camera.color_from_depth * camera_from_scan).translation().cast<float>()),
      voxel_size_mm_(static_cast<float>(options.voxel_size_mm)),
      color_band_mm_(2.0F * voxel_size_mm_) {}

void BlockUpdate::apply(BlockGrid& grid, int block) const {
  const Eigen::Vector3f origin =
      grid.coordinates(block).cast<float>() * (voxel_size_mm_ * static_cast<float>(kBlockSide));
  const Intrinsics& k = planes_.intrinsics;
  const FrameArrays arrays{.nx = planes_.nx.data(),
                           .ny = planes_.ny.data(),
                           .nz = planes_.nz.data(),
                           .offset_mm = planes_.offset_mm.data(),
                           .quality = planes_.quality.data(),
                           .fx = static_cast<float>(k.fx_px),
                           .fy = static_cast<float>(k.fy_px),
                           .cx = static_cast<float>(k.cx_px + 0.5),
                           .cy = static_cast<float>(k.cy_px + 0.5),
                           .width = static_cast<float>(k.width),
                           .height = static_cast<float>(k.height),
                           .row_length = k.width,
                           .outside = k.width * k.height};
  const Eigen::Vector3f first = rotation_ * origin + translation_;
  const Eigen::Matrix3f steps = rotation_ * voxel_size_mm_;
  const BlockFrame frame{.first = {first.x(), first.y(), first.z()},
                         .along_x = {steps(0, 0), steps(1, 0), steps(2, 0)},
                         .along_y = {steps(0, 1), steps(1, 1), steps(2, 1)},
                         .along_z = {steps(0, 2), steps(1, 2), steps(2, 2)}};
  const WeightNumbers numbers{.epsilon_mm = static_cast<float>(weighting_.epsilon_mm),
                              .delta_mm = static_cast<float>(weighting_.delta_mm),
                              .sigma_per_mm2 = static_cast<float>(weighting_.sigma_per_mm2)};
  Observed observed;
  observe(arrays, frame, observed);
  if (!anySpeaks(observed, numbers.delta_mm)) {
    return;
  }
  average(observed, numbers, grid.block(block));
  count(observed, numbers.delta_mm, grid.block(block));
  if (color_ != nullptr) {
    fuseColors(origin, observed.distance_mm, observed.quality, grid.colors(block));
  }
}

void BlockUpdate::fuseColors(const Eigen::Vector3f& first,
                             const std::array<float, kBlockVoxels>& distance_mm,
                             const std::array<float, kBlockVoxels>& quality,
                             ColorBlock& colors) const {
  const Eigen::Matrix3f steps = color_from_scan_rotation_ * voxel_size_mm_;
  const Eigen::Vector3f start = color_from_scan_rotation_ * first + color_from_scan_translation_;
  for (int i = 0; i < kBlockVoxels; ++i) {
    const auto voxel = static_cast<std::size_t>(i);
    if (std::abs(distance_mm[voxel]) < color_band_mm_ && quality[voxel] > 0.0F) {
      const Eigen::Vector3f at(
          static_cast<float>(i & 7), static_cast<float>((i >> 3) & 7), static_cast<float>(i >> 6));
      // Steep views smear colour over many voxels: they count less than for the distance.
      fuseColor(start + steps * at, quality[voxel] * quality[voxel], i, colors);
    }
  }
}

/// @param p_color  in the colour camera's frame [mm]
void BlockUpdate::fuseColor(const Eigen::Vector3f& p_color,
                            float weight,
                            int voxel,
                            ColorBlock& colors) const {
  if (p_color.z() <= 1.0F) {
    return;
  }
  const Intrinsics& k = camera_.color;
  const float inverse = 1.0F / p_color.z();
  const float u =
      static_cast<float>(k.fx_px) * p_color.x() * inverse + static_cast<float>(k.cx_px + 0.5);
  const float v =
      static_cast<float>(k.fy_px) * p_color.y() * inverse + static_cast<float>(k.cy_px + 0.5);
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

}  // namespace tarsus
