#include "reconstruction/texture/color_alignment.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/lattice_step.h"
#include "reconstruction/texture/picture_sums.h"
#include "reconstruction/texture/reduced_image.h"
#include "reconstruction/texture/sight_patches.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

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
      anchors_.push_back(anchorOf(picture));
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
    if (options_.lattice_iterations > 0 && sums_->totalWeight() > 0.0 && !job_.stopped()) {
      useLattices();
      iterate(options_.lattice_iterations, result_.lattice);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool bending() const { return !lattices_.empty(); }

  void useSize(const Size& size) {
    factor_ = size.factor;
    small_ = reduced(camera_, factor_);
    parallelFor(static_cast<int>(pictures_.size()), [&](int k) {
      const auto i = static_cast<std::size_t>(k);
      intensity_[i] = reduced(pictures_[i].intensity, size.factor);
      images_[i].intensity = &intensity_[i];
    });
    const auto factor = static_cast<std::size_t>(size.factor);
    usePatches({.thinning = factor * factor, .least_trust = size.least_trust, .cell_of = {}});
    if (size.factor == 1) {
      result_.vertex_observations = sums_->observations();
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
    sums_.emplace(makeSightPatches(vertices_, order_, pictures_, choice),
                  pictures_.size(),
                  bending() ? PictureSums::Kind::Cells : PictureSums::Kind::Rigid,
                  static_cast<float>(options_.outlier_levels * factor_));
  }

  void placeImages() {
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      PlacedImage& image = images_[i];
      const RigidTransform& pose = pictures_[i].place.color_from_scan;
      for (int k = 0; k < 9; ++k) {
        image.rotation[static_cast<std::size_t>(k)] =
            static_cast<float>(pose.linear()(k / 3, k % 3));
      }
      const Eigen::Vector3d& pivot = anchors_[i].center;
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

  /// Without depth, a picture is held loosely where it begins: one that shows nothing but noise
  /// must not wander. Motions turn about what it looks at, so that turns and shifts hardly couple.
  [[nodiscard]] PoseAnchor anchorOf(const AlignedPicture& picture) const {
    if (picture.anchor) {
      return *picture.anchor;
    }
    PoseAnchor anchor{.color_from_scan = picture.place.color_from_scan};
    if (!picture.sight.empty()) {
      const SightLine& middle = picture.sight[picture.sight.size() / 2];
      anchor.center = anchor.color_from_scan * vertices_[middle.vertex].cast<double>();
    }
    const double softer = options_.anchor_mm / options_.loose_anchor_mm;
    anchor.stiffness = softer * softer * MotionMatrix::Identity();
    return anchor;
  }

  /// @return robust sum of squares [grey levels^2] with the priors
  double evaluate() {
    placeImages();
    const Agreement agreement = sums_->evaluate(images_);
    if (variance_ < 0.0) {  // a phase begins: its priors count against this disagreement
      variance_ = agreement.variance();
    }
    double energy = agreement.loss;
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      energy += bending() ? priorEnergy(pictures_[k].place.warp, latticePrior()) : anchorEnergy(k);
    }
    return energy;
  }

  // --- rigid steps

  [[nodiscard]] double anchorWeight(std::size_t picture) const {
    return sums_->weights()[picture] * variance_ / (options_.anchor_mm * options_.anchor_mm);
  }

  [[nodiscard]] double anchorEnergy(std::size_t picture) const {
    const PoseAnchor& anchor = anchors_[picture];
    const MotionVector away = motionBetween(
        pictures_[picture].place.color_from_scan, anchor.color_from_scan, anchor.center);
    return anchorWeight(picture) * away.dot(anchor.stiffness * away);
  }

  void planRigidSteps() {
    const std::vector<RigidEquations> all = sums_->rigidEquations();
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      base_poses_[k] = pictures_[k].place.color_from_scan;
      const MotionMatrix stiffness = anchorWeight(k) * anchors_[k].stiffness;
      MotionMatrix normal = all[k].normal + stiffness;
      const MotionVector right =
          all[k].right + stiffness * motionBetween(base_poses_[k],
                                                   anchors_[k].color_from_scan,
                                                   anchors_[k].center);
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
    const std::vector<CellEquations> cells =
        sums_->cellEquations(pictures_[0].place.warp.offsets_px().size());
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
        place.color_from_scan =
            motionOf(share * rigid_steps_[k], anchors_[k].center) * base_poses_[k];
        continue;
      }
      for (std::size_t i = 0; i < base_offsets_[k].size(); ++i) {
        place.warp.offsets_px()[i] =
            base_offsets_[k][i] + static_cast<float>(share) * lattice_steps_[k][i];
      }
    }
  }

  void iterate(int iterations, AlignmentPhase& phase) {
    if (iterations <= 0 || !(sums_->totalWeight() > 0.0)) {
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    const bool full_size = &phase != &result_.rigid_small_sizes;
    variance_ = -1.0;
    double current = evaluate();
    if (full_size && result_.rmse.empty()) {
      result_.rmse.push_back(std::sqrt(current / sums_->totalWeight()));
    }
    for (int done = 0; done < iterations && !job_.stopped(); ++done) {
      report();
      const double next = step(current);
      const bool slow = current - next < options_.least_relative_drop * current;
      current = next;
      ++phase.iterations;
      if (full_size) {
        result_.rmse.push_back(std::sqrt(current / sums_->totalWeight()));
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
    sums_->keepMeans();
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
  std::vector<PoseAnchor> anchors_;
  const ColorAlignmentOptions& options_;
  const Job& job_;
  ColorAlignment result_;
  int iterations_done_ = 0;

  // of the size in work
  std::vector<std::uint32_t> order_;
  int factor_ = 1;
  Intrinsics small_;
  std::vector<PlacedImage> images_;
  std::vector<Image<float>> intensity_;
  std::optional<PictureSums> sums_;
  double variance_ = 0.0;  ///< mean robust square when the phase began [grey levels^2]

  // of the last plan
  std::vector<MotionVector> rigid_steps_;
  std::vector<RigidTransform> base_poses_;
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
