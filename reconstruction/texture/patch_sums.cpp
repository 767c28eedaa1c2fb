#include "reconstruction/texture/patch_sums.h"

#include "reconstruction/base/vector_code.h"
#include "reconstruction/scene/rigid_motion.h"
#include "reconstruction/texture/lanes.h"

#include <algorithm>

namespace tarsus {
namespace {

/// The bilinear surface through the four pixels around each place, and its slopes.
TARSUS_INLINE void sampleImage(const Image<float>& image, Lanes u, Lanes v, SightSample& sample) {
  clamp(u, 0.0F, static_cast<float>(image.width()) - 1.001F);
  clamp(v, 0.0F, static_cast<float>(image.height()) - 1.001F);
  const LaneInts left = __builtin_convertvector(u, LaneInts);
  const LaneInts top = __builtin_convertvector(v, LaneInts);
  const LaneInts first = top * image.width() + left;
  std::array<std::int32_t, kLanes> index;
  std::memcpy(index.data(), &first, sizeof(first));
  const float* const pixels = image.pixels().data();
  Lanes upper_left;
  Lanes upper_right;
  Lanes lower_left;
  Lanes lower_right;
  gatherPairs(pixels, index, upper_left, upper_right);
  gatherPairs(pixels + image.width(), index, lower_left, lower_right);
  const Lanes a = u - __builtin_convertvector(left, Lanes);
  const Lanes b = v - __builtin_convertvector(top, Lanes);
  const Lanes du_upper = upper_right - upper_left;
  const Lanes du_lower = lower_right - lower_left;
  const Lanes upper = upper_left + a * du_upper;
  const Lanes dv = lower_left + a * du_lower - upper;
  store(upper + b * dv, sample.value);
  store(du_upper + b * (du_lower - du_upper), sample.du);
  store(dv, sample.dv);
}

/// The lattice's offsets at the four nodes of a cell.
struct BentCell {
  float per_px = 0.0F;
  float column = 0.0F;
  float row = 0.0F;
  std::array<Eigen::Vector2f, 4> offset;
};

BentCell bentCell(const ControlLattice& warp, std::uint32_t cell) {
  const auto columns = static_cast<std::uint32_t>(warp.columns());
  const std::vector<Eigen::Vector2f>& offsets = warp.offsets_px();
  return {warp.cellsPerPx(),
          static_cast<float>(cell % columns),
          static_cast<float>(cell / columns),
          {offsets[cell], offsets[cell + 1], offsets[cell + columns], offsets[cell + columns + 1]}};
}

TARSUS_INLINE void bend(const BentCell& cell, Lanes& u, Lanes& v, SightSample& sample) {
  Lanes a = u * cell.per_px - cell.column;
  Lanes b = v * cell.per_px - cell.row;
  clamp(a, 0.0F, 1.0F);
  clamp(b, 0.0F, 1.0F);
  store(a, sample.right);
  store(b, sample.down);
  const auto& [upper_left, upper_right, lower_left, lower_right] = cell.offset;
  for (int k = 0; k < 2; ++k) {
    const Lanes upper = upper_left[k] + a * (upper_right[k] - upper_left[k]);
    const Lanes lower = lower_left[k] + a * (lower_right[k] - lower_left[k]);
    (k == 0 ? u : v) += upper + b * (lower - upper);
  }
}

TARSUS_MANY_SUMS
void sampleRun(const SightPatch& patch,
               const SightRun& run,
               const PlacedImage& image,
               SightSample* samples) {
  const std::array<float, 9>& r = image.rotation;
  const std::array<float, 3>& t = image.translation;
  const BentCell cell = image.warp != nullptr ? bentCell(*image.warp, run.cell) : BentCell();
  for (std::uint32_t i = run.first_block; i < run.first_block + run.blocks; ++i) {
    const SightBlock& block = patch.blocks[i];
    SightSample& sample = samples[i];
    Lanes px;
    Lanes py;
    Lanes pz;
    gather(patch.x_mm.data(), block.vertex, px);
    gather(patch.y_mm.data(), block.vertex, py);
    gather(patch.z_mm.data(), block.vertex, pz);
    const Lanes x = r[0] * px + r[1] * py + r[2] * pz + t[0];
    const Lanes y = r[3] * px + r[4] * py + r[5] * pz + t[1];
    const Lanes z = r[6] * px + r[7] * py + r[8] * pz + t[2];
    store(x, sample.x);
    store(y, sample.y);
    store(z, sample.z);
    const Lanes per_z = 1.0F / z;
    Lanes u = image.fx_px * x * per_z + image.cx_px;
    Lanes v = image.fy_px * y * per_z + image.cy_px;
    if (image.warp != nullptr) {
      bend(cell, u, v, sample);
    }
    sampleImage(*image.intensity, u, v, sample);
  }
}

/// What is left of residuals' weights: (1 + (r / outlier)^2)^-2, of Geman and McClure's loss.
TARSUS_INLINE void robustWeight(const Lanes& residual, float outlier, Lanes& weight, Lanes& near) {
  const Lanes relative = residual * (1.0F / outlier);
  near = 1.0F / (1.0F + relative * relative);
  weight = near * near;
}

TARSUS_MANY_SUMS
void addWeighted(const SightPatch& patch,
                 const SightSample* samples,
                 const float* centers,
                 float outlier,
                 WeightedSum* sums) {
  for (std::size_t i = 0; i < patch.blocks.size(); ++i) {
    const SightBlock& block = patch.blocks[i];
    Lanes weight;
    Lanes value;
    load(block.weight, weight);
    load(samples[i].value, value);
    if (centers != nullptr) {
      Lanes center;
      Lanes counted;
      Lanes near;
      gather(centers, block.vertex, center);
      robustWeight(value - center, outlier, counted, near);
      weight = weight * counted;
    }
    LaneArray own_weight;
    LaneArray own_value;
    store(weight, own_weight);
    store(weight * value, own_value);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      WeightedSum& sum = sums[block.vertex[lane]];
      sum.weight += own_weight[lane];
      sum.value += own_value[lane];
    }
  }
}

/// The rest of each line of sight, and how it counts.
struct Rest {
  Lanes residual;
  Lanes weight;
  Lanes loss;
};

TARSUS_INLINE void restOf(const SightBlock& block,
                          const SightSample& sample,
                          const float* wanted,
                          float outlier,
                          Rest& rest) {
  Lanes value;
  Lanes level;
  Lanes weight;
  Lanes counted;
  Lanes near;
  load(sample.value, value);
  gather(wanted, block.vertex, level);
  load(block.weight, weight);
  rest.residual = level - value;
  robustWeight(rest.residual, outlier, counted, near);
  rest.weight = weight * counted;
  rest.loss = weight * rest.residual * rest.residual * near;
}

TARSUS_MANY_SUMS
void sumRigidRun(const SightPatch& patch,
                 const SightRun& run,
                 const PlacedImage& image,
                 const SightSample* samples,
                 const float* wanted,
                 float outlier,
                 RigidSums& sums) {
  constexpr auto kPerLever = static_cast<float>(1.0 / kMotionLever_mm);
  std::array<Lanes, kRigidSums> total{};
  for (std::uint32_t i = run.first_block; i < run.first_block + run.blocks; ++i) {
    const SightSample& sample = samples[i];
    Rest rest;
    restOf(patch.blocks[i], sample, wanted, outlier, rest);
    Lanes x;
    Lanes y;
    Lanes z;
    Lanes gx;
    Lanes gy;
    load(sample.x, x);
    load(sample.y, y);
    load(sample.z, z);
    load(sample.du, gx);
    load(sample.dv, gy);
    const Lanes per_z = 1.0F / z;
    gx = gx * image.fx_px * per_z;
    gy = gy * image.fy_px * per_z;
    const Lanes gz = -(gx * x + gy * y) * per_z;
    const Lanes ax = (x - image.pivot[0]) * kPerLever;
    const Lanes ay = (y - image.pivot[1]) * kPerLever;
    const Lanes az = (z - image.pivot[2]) * kPerLever;
    const std::array<Lanes, 6> row{
        ay * gz - az * gy, az * gx - ax * gz, ax * gy - ay * gx, gx, gy, gz};
    const Lanes pull = rest.weight * rest.residual;
    std::size_t index = 0;
    for (std::size_t j = 0; j < 6; ++j) {
      const Lanes weighted = rest.weight * row[j];
      for (std::size_t k = 0; k <= j; ++k, ++index) {
        total[index] += weighted * row[k];
      }
      total[21 + j] += pull * row[j];
    }
    total[27] += rest.loss;
    total[28] += pull * rest.residual;
    total[29] += rest.weight;
  }
  for (std::size_t i = 0; i < kRigidSums; ++i) {
    sums[i] = sumOf(total[i]);
  }
}

TARSUS_MANY_SUMS
void sumCellRun(const SightPatch& patch,
                const SightRun& run,
                const SightSample* samples,
                const float* wanted,
                float outlier,
                CellSums& sums) {
  std::array<Lanes, kCellSums> total{};
  for (std::uint32_t i = run.first_block; i < run.first_block + run.blocks; ++i) {
    const SightSample& sample = samples[i];
    Rest rest;
    restOf(patch.blocks[i], sample, wanted, outlier, rest);
    Lanes a;
    Lanes b;
    Lanes du;
    Lanes dv;
    load(sample.right, a);
    load(sample.down, b);
    load(sample.du, du);
    load(sample.dv, dv);
    const std::array<Lanes, 4> share{
        (1.0F - a) * (1.0F - b), a * (1.0F - b), (1.0F - a) * b, a * b};
    const std::array<Lanes, 3> product{
        rest.weight * du * du, rest.weight * du * dv, rest.weight * dv * dv};
    const Lanes pull_u = rest.weight * rest.residual * du;
    const Lanes pull_v = rest.weight * rest.residual * dv;
    std::size_t index = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k <= j; ++k) {
        const Lanes both = share[j] * share[k];
        for (std::size_t m = 0; m < 3; ++m, ++index) {
          total[index] += both * product[m];
        }
      }
      total[30 + 2 * j] += share[j] * pull_u;
      total[31 + 2 * j] += share[j] * pull_v;
    }
    total[38] += rest.loss;
    total[39] += rest.weight * rest.residual * rest.residual;
    total[40] += rest.weight;
  }
  for (std::size_t i = 0; i < kCellSums; ++i) {
    sums[i] = sumOf(total[i]);
  }
}

}  // namespace

void PatchSums::sample(const SightPatch& patch, std::span<const PlacedImage> images) {
  samples_.resize(patch.blocks.size());
  for (const SightRun& run : patch.runs) {
    sampleRun(patch, run, images[run.picture], samples_.data());
  }
}

void PatchSums::average(const SightPatch& patch,
                        std::span<const float> centers,
                        std::span<float> wanted) {
  const std::size_t count = patch.x_mm.size();
  const auto mean = [&](const float* around) {
    weighted_sums_.assign(count, {});
    addWeighted(patch, samples_.data(), around, outlier_levels_, weighted_sums_.data());
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [weight, value] = weighted_sums_[i];
      wanted[i] = weight > 0.0F ? value / weight : 0.0F;
    }
  };
  if (centers.empty()) {
    mean(nullptr);
    plain_means_.assign(wanted.begin(), wanted.end());
    mean(plain_means_.data());
  } else {
    mean(centers.data());
  }
}

void PatchSums::sumRigid(const SightPatch& patch,
                         std::span<const PlacedImage> images,
                         std::span<const float> wanted,
                         std::span<RigidSums> sums) const {
  for (std::size_t i = 0; i < patch.runs.size(); ++i) {
    const SightRun& run = patch.runs[i];
    sumRigidRun(
        patch, run, images[run.picture], samples_.data(), wanted.data(), outlier_levels_, sums[i]);
  }
}

void PatchSums::sumCells(const SightPatch& patch,
                         std::span<const float> wanted,
                         std::span<CellSums> sums) const {
  for (std::size_t i = 0; i < patch.runs.size(); ++i) {
    sumCellRun(patch, patch.runs[i], samples_.data(), wanted.data(), outlier_levels_, sums[i]);
  }
}

}  // namespace tarsus
