#include "reconstruction/texture/color_alignment.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/lattice_step.h"
#include "reconstruction/texture/patch_sums.h"
#include "reconstruction/texture/reduced_image.h"
#include "reconstruction/texture/sight_patches.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace tarsus {
namespace {

constexpr int kHalvings = 5;  // of a step before it is dropped
/// Lines of sight that tell the same: vertices lie closer than the smoothed pixels are wide.
constexpr double kSightPerPixel = 6.0;

/// One size of the pyramid: how small, its share of the rigid iterations, and how far from edges
/// of the model a vertex must lie (SightLine::trust): other surfaces bleed into small images.
struct Size {
  int factor;
  double share;
  float least_trust;
};
constexpr std::array kSizes{Size{4, 0.4, 1.0F}, Size{2, 0.3, 0.7F}, Size{1, 0.3, 0.0F}};

class Alignment {
 public:
  Alignment(std::span<const Eigen::Vector3f> vertices,
            const Intrinsics& camera,
            std::span<AlignedPicture> pictures,
            const ColorAlignmentOptions& options,
            const Job& job)
      : vertices_(vertices),
        camera_(camera),
        pictures_(pictures),
        options_(options),
        job_(job),
        order_(mortonOrder(vertices)),
        images_(pictures.size()),
        intensity_(pictures.size()),
        rigid_steps_(pictures.size(), MotionVector::Zero()),
        base_poses_(pictures.size()) {
    for (AlignedPicture& picture : pictures_) {
      picture.place.warp = ControlLattice();
    }
  }

  ColorAlignment run() {
    int left = options_.rigid_iterations;
    for (const Size& size : kSizes) {
      const bool last = size.factor == 1;
      const int own = last ? left : static_cast<int>(size.share * options_.rigid_iterations);
      left -= own;
      useSize(size);
      iterate(own, last ? result_.rigid_full_size : result_.rigid_small_sizes);
    }
    if (options_.lattice_iterations > 0 && total_weight_ > 0.0 && !job_.stopped()) {
      useLattices();
      iterate(options_.lattice_iterations, result_.lattice);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool bending() const { return !lattices_.empty(); }

  void useSize(const Size& size) {
    small_ = reduced(camera_, size.factor);
    parallelFor(static_cast<int>(pictures_.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      intensity_[i] = reduced(pictures_[i].intensity, size.factor);
      images_[i].intensity = &intensity_[i];
    });
    const auto factor = static_cast<std::size_t>(size.factor);
    usePatches({.thinning = factor * factor, .least_trust = size.least_trust, .cell_of = {}});
    if (size.factor == 1) {
      result_.vertex_observations = observations_;
    }
  }

  void useLattices() {
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      ControlLattice& warp = pictures_[i].place.warp;
      warp = ControlLattice(camera_.width, camera_.height, options_.lattice_columns);
      images_[i].warp = &warp;
      lattices_.emplace_back(warp);
    }
    base_offsets_.resize(pictures_.size());
    lattice_steps_.resize(pictures_.size());
    usePatches({.cell_of = [this](std::size_t picture, const Eigen::Vector3f& p) {
      const Eigen::Vector3d in_camera = pictures_[picture].place.color_from_scan * p.cast<double>();
      const Eigen::Vector2f place = camera_.project(in_camera).cast<float>();
      const ControlLattice::Cell cell = pictures_[picture].place.warp.cellAt(place);
      return static_cast<std::uint32_t>(cell.node[0]);
    }});
  }

  void usePatches(const PatchChoice& choice) {
    patches_ = makeSightPatches(vertices_, order_, pictures_, choice);
    first_run_.assign(patches_.size() + 1, 0);
    first_vertex_.assign(patches_.size() + 1, 0);
    total_weight_ = 0.0;
    observations_ = 0;
    weights_.assign(pictures_.size(), 0.0);
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
    centers_.clear();
    rigid_sums_.resize(bending() ? 0 : first_run_.back());
    cell_sums_.resize(bending() ? first_run_.back() : 0);
  }

  void placeImages() {
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      PlacedImage& image = images_[i];
      const RigidTransform& pose = pictures_[i].place.color_from_scan;
      for (int k = 0; k < 9; ++k) {
        image.rotation[static_cast<std::size_t>(k)] =
            static_cast<float>(pose.linear()(k / 3, k % 3));
      }
      const Eigen::Vector3d pivot = pivotOf(i);
      for (int k = 0; k < 3; ++k) {
        const auto j = static_cast<std::size_t>(k);
        image.translation[j] = static_cast<float>(pose.translation()[k]);
        image.pivot[j] = static_cast<float>(pivot[k]);
      }
      image.fx_px = static_cast<float>(small_.fx_px);
      image.fy_px = static_cast<float>(small_.fy_px);
      image.cx_px = static_cast<float>(small_.cx_px);
      image.cy_px = static_cast<float>(small_.cy_px);
    }
  }

  /// Rigid steps turn about what the picture looks at, so that turns and shifts hardly couple.
  [[nodiscard]] Eigen::Vector3d pivotOf(std::size_t picture) const {
    const AlignedPicture& own = pictures_[picture];
    if (own.anchor) {
      return own.anchor->center;
    }
    if (own.sight.empty()) {
      return Eigen::Vector3d::Zero();
    }
    const SightLine& middle = own.sight[own.sight.size() / 2];
    return own.place.color_from_scan * vertices_[middle.vertex].cast<double>();
  }

  /// Goes through all patches: what the pictures say together, and how each differs from it.
  /// @return robust sum of squares [grey levels^2] with the priors
  double evaluate() {
    placeImages();
    parallelFor(static_cast<int>(patches_.size()),
                [this](int i) { evaluatePatch(static_cast<std::size_t>(i)); });
    double energy = 0.0;
    if (bending()) {
      for (const CellSums& sums : cell_sums_) {
        energy += static_cast<double>(sums.back());
      }
    } else {
      for (const RigidSums& sums : rigid_sums_) {
        energy += static_cast<double>(sums.back());
      }
    }
    if (variance_ < 0.0) {  // a phase begins: its priors count against this disagreement
      variance_ = total_weight_ > 0.0 ? energy / total_weight_ : 0.0;
    }
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      energy += bending() ? priorEnergy(pictures_[k].place.warp, latticePrior()) : anchorEnergy(k);
    }
    return energy;
  }

  void evaluatePatch(std::size_t i) {
    thread_local PatchSums sums;
    sums.useHuber(static_cast<float>(options_.huber_levels));
    const SightPatch& patch = patches_[i];
    const std::size_t first = first_vertex_[i];
    const std::size_t count = patch.x_mm.size();
    const std::span<float> wanted = std::span(wanted_).subspan(first, count);
    const std::span<const float> centers =
        centers_.empty() ? std::span<const float>() : std::span(centers_).subspan(first, count);
    const std::size_t runs = patch.runs.size();
    sums.sample(patch, images_);
    sums.average(patch, centers, wanted);
    if (bending()) {
      sums.sumCells(patch, wanted, std::span(cell_sums_).subspan(first_run_[i], runs));
    } else {
      sums.sumRigid(patch, images_, wanted, std::span(rigid_sums_).subspan(first_run_[i], runs));
    }
  }

  // --- rigid steps

  [[nodiscard]] double anchorWeight(std::size_t picture) const {
    return weights_[picture] * variance_ / (options_.anchor_mm * options_.anchor_mm);
  }

  [[nodiscard]] double anchorEnergy(std::size_t picture) const {
    const AlignedPicture& own = pictures_[picture];
    if (!own.anchor) {
      return 0.0;
    }
    const MotionVector away =
        motionBetween(own.place.color_from_scan, own.anchor->color_from_scan, own.anchor->center);
    return anchorWeight(picture) * away.dot(own.anchor->stiffness * away);
  }

  struct RigidEquations {
    MotionMatrix normal = MotionMatrix::Zero();
    MotionVector right = MotionVector::Zero();
  };

  [[nodiscard]] std::vector<RigidEquations> rigidEquations() const {
    std::vector<RigidEquations> all(pictures_.size());
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
    return all;
  }

  void planRigidSteps() {
    const std::vector<RigidEquations> all = rigidEquations();
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      base_poses_[k] = pictures_[k].place.color_from_scan;
      pivots_.resize(pictures_.size());
      pivots_[k] = pivotOf(k);
      MotionMatrix normal = all[k].normal.selfadjointView<Eigen::Lower>();
      MotionVector right = all[k].right;
      if (const auto& anchor = pictures_[k].anchor) {
        const MotionMatrix stiffness = anchorWeight(k) * anchor->stiffness;
        normal += stiffness;
        right += stiffness * motionBetween(base_poses_[k], anchor->color_from_scan, anchor->center);
      }
      normal += 1e-6 * normal.trace() * MotionMatrix::Identity();
      const MotionVector step = normal.ldlt().solve(right);
      rigid_steps_[k] = step.allFinite() ? step : MotionVector::Zero();
    }
  }

  // --- steps of the lattices

  [[nodiscard]] LatticePrior latticePrior() const {
    const double unit = kSightPerPixel * variance_;
    return {.offset = unit / (options_.lattice_offset_px * options_.lattice_offset_px),
            .bend = unit / (options_.lattice_bend_px * options_.lattice_bend_px)};
  }

  void planLatticeSteps() {
    using Cells = std::vector<std::array<double, kCellSums>>;
    std::vector<Cells> cells(pictures_.size(), Cells(pictures_[0].place.warp.offsets_px().size()));
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      for (std::size_t r = 0; r < patches_[i].runs.size(); ++r) {
        const SightRun& run = patches_[i].runs[r];
        const CellSums& sums = cell_sums_[first_run_[i] + r];
        std::array<double, kCellSums>& own = cells[run.picture][run.cell];
        for (std::size_t j = 0; j < kCellSums; ++j) {
          own[j] += static_cast<double>(sums[j]);
        }
      }
    }
    parallelFor(static_cast<int>(pictures_.size()), [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      base_offsets_[k] = pictures_[k].place.warp.offsets_px();
      lattice_steps_[k] = lattices_[k].solve(cells[k], base_offsets_[k], latticePrior());
    });
  }

  // --- both

  void plan() { bending() ? planLatticeSteps() : planRigidSteps(); }

  /// Goes to the place before the planned step, plus so much of that step.
  void moveAll(double share) {
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      PicturePlacement& place = pictures_[k].place;
      if (!bending()) {
        place.color_from_scan = motionOf(share * rigid_steps_[k], pivots_[k]) * base_poses_[k];
        continue;
      }
      for (std::size_t i = 0; i < base_offsets_[k].size(); ++i) {
        place.warp.offsets_px()[i] =
            base_offsets_[k][i] + static_cast<float>(share) * lattice_steps_[k][i];
      }
    }
  }

  void iterate(int iterations, AlignmentPhase& phase) {
    if (iterations <= 0 || !(total_weight_ > 0.0)) {
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    const bool full_size = &phase != &result_.rigid_small_sizes;
    variance_ = -1.0;
    double current = evaluate();
    if (full_size && result_.rmse.empty()) {
      result_.rmse.push_back(std::sqrt(current / total_weight_));
    }
    for (int done = 0; done < iterations && !job_.stopped(); ++done) {
      report();
      const double next = step(current);
      const bool slow = current - next < options_.least_relative_drop * current;
      current = next;
      ++phase.iterations;
      if (full_size) {
        result_.rmse.push_back(std::sqrt(current / total_weight_));
      }
      if (slow) {
        break;
      }
    }
    phase.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  /// Takes as much of the planned step as makes the whole better.
  double step(double current) {
    centers_ = wanted_;
    plan();
    double share = 1.0;
    for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
      moveAll(share);
      const double next = evaluate();
      if (next <= current) {
        return next;
      }
    }
    moveAll(0.0);
    return std::min(current, evaluate());
  }

  void report() {
    ++iterations_done_;
    const double all = std::max(1, options_.rigid_iterations + options_.lattice_iterations);
    job_.report("align colours", std::min(1.0, iterations_done_ / all));
  }

  std::span<const Eigen::Vector3f> vertices_;
  const Intrinsics camera_;
  std::span<AlignedPicture> pictures_;
  const ColorAlignmentOptions& options_;
  const Job& job_;
  ColorAlignment result_;
  int iterations_done_ = 0;

  // of the size in work
  std::vector<std::uint32_t> order_;
  Intrinsics small_;
  std::vector<PlacedImage> images_;
  std::vector<Image<float>> intensity_;
  std::vector<SightPatch> patches_;
  std::vector<std::size_t> first_run_;     ///< of each patch, in the sums
  std::vector<std::size_t> first_vertex_;  ///< of each patch, in the grey levels
  std::vector<double> weights_;            ///< of each picture's lines of sight
  double total_weight_ = 0.0;
  double variance_ = 0.0;  ///< mean robust square when the phase began [grey levels^2]
  std::size_t observations_ = 0;

  // of the last evaluation and the last plan
  std::vector<float> wanted_;
  std::vector<float> centers_;
  std::vector<RigidSums> rigid_sums_;
  std::vector<CellSums> cell_sums_;
  std::vector<MotionVector> rigid_steps_;
  std::vector<RigidTransform> base_poses_;
  std::vector<Eigen::Vector3d> pivots_;
  std::vector<LatticeStep> lattices_;
  std::vector<std::vector<Eigen::Vector2f>> base_offsets_;
  std::vector<std::vector<Eigen::Vector2f>> lattice_steps_;
};

}  // namespace

ColorAlignment alignPictures(std::span<const Eigen::Vector3f> vertices,
                             const Intrinsics& camera,
                             std::span<AlignedPicture> pictures,
                             const ColorAlignmentOptions& options,
                             const Job& job) {
  if (pictures.empty() || vertices.empty()) {
    return {};
  }
  return Alignment(vertices, camera, pictures, options, job).run();
}

}  // namespace tarsus
