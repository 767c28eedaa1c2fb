#include "reconstruction/fusion/tsdf_volume.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/fusion/block_grid.h"
#include "reconstruction/fusion/block_update.h"
#include "reconstruction/fusion/depth_planes.h"
#include "reconstruction/fusion/depth_tiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kBlocksPerTask = 16;

/// Blocks that the band around the frame's surface touches, in the order in which the image shows
/// them first; each once.
class BandBlocks {
 public:
  BandBlocks(BlockGrid& grid, std::vector<int>& last_frame, int frame)
      : grid_(grid), last_frame_(last_frame), frame_(frame) {}

  /// Every block that a cube around p reaches into.
  void touch(const Eigen::Vector3f& p_scan, float half_width_mm) {
    const float scale = 1.0F / (grid_.voxelSize() * static_cast<float>(kBlockSide));
    const Eigen::Vector3f reach = Eigen::Vector3f::Constant(half_width_mm);
    const Eigen::Vector3f low = (p_scan - reach) * scale;
    const Eigen::Vector3f high = (p_scan + reach) * scale;
    const Eigen::Vector3i first = low.array().floor().cast<int>();
    const Eigen::Vector3i last = high.array().floor().cast<int>();
    if (first == last && first == previous_) {
      return;
    }
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) {
          add({x, y, z});
        }
      }
    }
    previous_ = last;
  }
  /// Every block that a ball around p reaches into.
  void touchBall(const Eigen::Vector3f& p_scan, float radius_mm) {
    const float side_mm = grid_.voxelSize() * static_cast<float>(kBlockSide);
    const Eigen::Vector3f reach = Eigen::Vector3f::Constant(radius_mm);
    const Eigen::Vector3i first = ((p_scan - reach) / side_mm).array().floor().cast<int>();
    const Eigen::Vector3i last = ((p_scan + reach) / side_mm).array().floor().cast<int>();
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) {
          const Eigen::Vector3i at(x, y, z);
          const Eigen::Vector3f corner = at.cast<float>() * side_mm;
          const Eigen::Vector3f nearest =
              p_scan.cwiseMax(corner).cwiseMin(corner + Eigen::Vector3f::Constant(side_mm));
          if ((nearest - p_scan).squaredNorm() <= radius_mm * radius_mm) {
            add(at);
          }
        }
      }
    }
  }
  [[nodiscard]] const std::vector<int>& blocks() const { return blocks_; }

 private:
  void add(const Eigen::Vector3i& at) {
    const int block = grid_.findOrAdd(at);
    if (block < 0) {
      return;
    }
    const auto i = static_cast<std::size_t>(block);
    if (i >= last_frame_.size()) {
      last_frame_.resize(i + 1, -1);
    }
    if (last_frame_[i] != frame_) {
      last_frame_[i] = frame_;
      blocks_.push_back(block);
    }
  }

  BlockGrid& grid_;
  std::vector<int>& last_frame_;
  int frame_;
  std::vector<int> blocks_;
  Eigen::Vector3i previous_ = Eigen::Vector3i::Constant(1 << 28);
};

/// Walks through the band of +-delta along the normals of a strided set of pixels; the cubes around
/// the samples leave no gap between them.
void touchBand(BandBlocks& band,
               const DepthPlanes& planes,
               const RigidTransform& scan_from_camera,
               const TsdfOptions& options) {
  const Intrinsics& k = planes.intrinsics;
  const auto delta = static_cast<float>(options.weighting.delta_mm);
  const auto block_mm = static_cast<float>(options.voxel_size_mm) * kBlockSide;
  const auto focal = static_cast<float>(std::min(k.fx_px, k.fy_px));
  // Pixels a quarter block apart at the usual distance of 400 mm.
  const int stride = std::clamp(static_cast<int>(block_mm * focal / (4.0F * 400.0F)), 1, 8);
  const int half_steps = static_cast<int>(std::ceil(2.0F * delta / block_mm));
  const float spacing = delta / static_cast<float>(half_steps);
  const Eigen::Matrix3f rotation = scan_from_camera.linear().cast<float>();
  const Eigen::Vector3f origin = scan_from_camera.translation().cast<float>();
  for (int v = 0; v < k.height; v += stride) {
    for (int u = 0; u < k.width; u += stride) {
      const std::size_t i = planes.index(u, v);
      if (planes.quality[i] <= 0.0F) {
        continue;
      }
      const float z = planes.depth_mm[i];
      const Eigen::Vector3f p = origin + rotation * (k.ray(u, v).cast<float>() * z);
      const Eigen::Vector3f step = rotation * planes.normal(i) * spacing;
      const float lateral = static_cast<float>(stride) * z / (focal * planes.quality[i]);
      const float half_width = 0.5F * std::clamp(lateral, spacing, 2.0F * spacing);
      for (int s = -half_steps; s <= half_steps; ++s) {
        band.touch(p + step * static_cast<float>(s), half_width);
      }
    }
  }
}

}  // namespace

double TsdfWeighting::weight(double distance_mm) const {
  const double distance = std::abs(distance_mm);
  if (distance < epsilon_mm) {
    return 1.0;
  }
  if (!(distance <= delta_mm)) {
    return 0.0;
  }
  const double beyond = distance - epsilon_mm;
  return std::exp(-sigma_per_mm2 * beyond * beyond);
}

TsdfVolume::TsdfVolume(const TsdfOptions& options) : grid_(std::make_unique<Grid>(options)) {}
TsdfVolume::TsdfVolume(TsdfVolume&&) noexcept = default;
TsdfVolume& TsdfVolume::operator=(TsdfVolume&&) noexcept = default;
TsdfVolume::~TsdfVolume() = default;

const TsdfOptions& TsdfVolume::options() const { return grid_->options; }

void TsdfVolume::integrate(const RgbdCamera& camera,
                           const RgbdFrame& frame,
                           const RigidTransform& scan_from_camera) {
  const DepthPlanes planes = fitDepthPlanes(camera.depth,
                                            frame.depth,
                                            {.min_depth_mm = options().min_depth_mm,
                                             .max_depth_mm = options().max_depth_mm,
                                             .max_depth_ratio = options().max_depth_ratio});
  integrate(camera, planes, frame.color, scan_from_camera);
}

std::vector<int> TsdfVolume::Grid::blocksInView(const DepthPlanes& planes,
                                                const RigidTransform& scan_from_camera) {
  if (!confined) {
    BandBlocks band(blocks, last_frame_of_block, frames);
    touchBand(band, planes, scan_from_camera, options);
    return band.blocks();
  }
  const DepthTiles tiles(planes, static_cast<float>(options.weighting.delta_mm));
  const Eigen::Isometry3f camera_from_scan = scan_from_camera.inverse().cast<float>();
  const float side_mm = blocks.voxelSize() * static_cast<float>(kBlockSide);
  const float radius_mm = 0.5F * std::numbers::sqrt3_v<float> * side_mm;
  std::vector<int> in_view;
  for (int i = 0; i < blocks.blockCount(); ++i) {
    const Eigen::Vector3f center =
        (blocks.coordinates(i).cast<float>() + Eigen::Vector3f::Constant(0.5F)) * side_mm;
    if (tiles.mayConcern(camera_from_scan * center, radius_mm)) {
      in_view.push_back(i);
    }
  }
  return in_view;
}

void TsdfVolume::confineTo(std::span<const Eigen::Vector3f> points, double reach_mm) {
  BandBlocks band(grid_->blocks, grid_->last_frame_of_block, -2);
  for (const Eigen::Vector3f& p : points) {
    band.touchBall(p, static_cast<float>(reach_mm));
  }
  grid_->confined = true;
}

void TsdfVolume::integrate(const RgbdCamera& camera,
                           const DepthPlanes& planes,
                           const ColorImage& color,
                           const RigidTransform& scan_from_camera) {
  BlockGrid& grid = grid_->blocks;
  const std::vector<int> blocks = grid_->blocksInView(planes, scan_from_camera);
  ++grid_->frames;
  grid_->changed_at.resize(static_cast<std::size_t>(grid.blockCount()), 0);
  for (const int block : blocks) {
    grid_->changed_at[static_cast<std::size_t>(block)] = grid_->frames;
  }
  const bool with_color = grid.hasColor() && color.width() == camera.color.width &&
                          color.height() == camera.color.height && color.width() > 0;
  const BlockUpdate update(
      camera, planes, with_color ? &color : nullptr, scan_from_camera.inverse(), grid_->options);
  const int count = static_cast<int>(blocks.size());
  parallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      update.apply(grid, blocks[static_cast<std::size_t>(i)]);
    }
  });
}

bool TsdfVolume::sample(const Eigen::Vector3f& p_scan, SdfSample& result) const {
  return grid_->blocks.sample(p_scan, result);
}

ExtractedSurface TsdfVolume::extractSurface(float min_weight) const {
  return extractFromGrid(grid_->blocks, min_weight);
}

std::size_t TsdfVolume::memoryBytes() const { return grid_->blocks.memoryBytes(); }

int TsdfVolume::blockCount() const { return grid_->blocks.blockCount(); }

int TsdfVolume::framesFused() const { return grid_->frames; }

std::vector<int> TsdfVolume::blocksChangedSince(int frames_fused) const {
  std::vector<int> changed;
  for (std::size_t i = 0; i < grid_->changed_at.size(); ++i) {
    if (grid_->changed_at[i] > frames_fused) {
      changed.push_back(static_cast<int>(i));
    }
  }
  return changed;
}

const BlockGrid& TsdfVolume::blocks() const { return grid_->blocks; }

}  // namespace tarsus
