#include "reconstruction/texture/picture_sums.h"

#include "reconstruction/base/parallel.h"

namespace tarsus {

PictureSums::PictureSums(std::vector<SightPatch> patches,
                         std::size_t picture_count,
                         Kind kind,
                         float outlier_levels)
    : patches_(std::move(patches)),
      kind_(kind),
      outlier_levels_(outlier_levels),
      first_run_(patches_.size() + 1, 0),
      first_vertex_(patches_.size() + 1, 0),
      weights_(picture_count, 0.0) {
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    first_run_[i + 1] = first_run_[i] + patches_[i].runs.size();
    first_vertex_[i + 1] = first_vertex_[i] + patches_[i].x_mm.size();
    for (const SightRun& run : patches_[i].runs) {
      for (std::uint32_t b = run.first_block; b < run.first_block + run.blocks; ++b) {
        for (const float weight : patches_[i].blocks[b].weight) {
          weights_[run.picture] += static_cast<double>(weight);
          observations_ += weight > 0.0F ? 1 : 0;
        }
      }
    }
  }
  for (const double weight : weights_) {
    total_weight_ += weight;
  }
  wanted_.assign(first_vertex_.back(), 0.0F);
  rigid_sums_.resize(kind == Kind::Rigid ? first_run_.back() : 0);
  cell_sums_.resize(kind == Kind::Cells ? first_run_.back() : 0);
}

Agreement PictureSums::evaluate(std::span<const PlacedImage> images) {
  parallelFor(static_cast<int>(patches_.size()),
              [&](int i) { evaluatePatch(static_cast<std::size_t>(i), images); });
  Agreement total;
  for (const CellSums& sums : cell_sums_) {
    total.add(robustSums(sums));
  }
  for (const RigidSums& sums : rigid_sums_) {
    total.add(robustSums(sums));
  }
  return total;
}

void PictureSums::evaluatePatch(std::size_t i, std::span<const PlacedImage> images) {
  thread_local PatchSums sums;
  sums.useOutlierLevels(outlier_levels_);
  const SightPatch& patch = patches_[i];
  const std::size_t first = first_vertex_[i];
  const std::size_t count = patch.x_mm.size();
  const std::size_t runs = patch.runs.size();
  const std::span<float> wanted = std::span(wanted_).subspan(first, count);
  std::span<const float> centers = centers_;
  if (!centers.empty()) {
    centers = centers.subspan(first, count);
  }
  sums.sample(patch, images);
  sums.average(patch, centers, wanted);
  if (kind_ == Kind::Cells) {
    sums.sumCells(patch, wanted, std::span(cell_sums_).subspan(first_run_[i], runs));
  } else {
    sums.sumRigid(patch, images, wanted, std::span(rigid_sums_).subspan(first_run_[i], runs));
  }
}

std::vector<RigidEquations> PictureSums::rigidEquations() const {
  std::vector<RigidEquations> all(weights_.size());
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    for (std::size_t r = 0; r < patches_[i].runs.size(); ++r) {
      const RigidSums& sums = rigid_sums_[first_run_[i] + r];
      RigidEquations& own = all[patches_[i].runs[r].picture];
      std::size_t index = 0;
      for (Eigen::Index j = 0; j < 6; ++j) {
        for (Eigen::Index k = 0; k <= j; ++k, ++index) {
          own.normal(j, k) += static_cast<double>(sums[index]);
        }
        own.right[j] += static_cast<double>(sums[21 + static_cast<std::size_t>(j)]);
      }
    }
  }
  for (RigidEquations& own : all) {
    own.normal = MotionMatrix(own.normal.selfadjointView<Eigen::Lower>());
  }
  return all;
}

std::vector<CellEquations> PictureSums::cellEquations(std::size_t nodes) const {
  std::vector<CellEquations> all(weights_.size(), CellEquations(nodes));
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    for (std::size_t r = 0; r < patches_[i].runs.size(); ++r) {
      const SightRun& run = patches_[i].runs[r];
      const CellSums& sums = cell_sums_[first_run_[i] + r];
      std::array<double, kCellSums>& own = all[run.picture][run.cell];
      for (std::size_t j = 0; j < kCellSums; ++j) {
        own[j] += static_cast<double>(sums[j]);
      }
    }
  }
  return all;
}

}  // namespace tarsus
