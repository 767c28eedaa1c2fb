#include "reconstruction/fusion/pose_adjustment.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/rigid_motion.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tarsus {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;

/// Patches are cubes of this side; within one, the field's shape is believed.
constexpr float kPatch_mm = 8.0F;
/// Neighbouring frames keep their motion in directions that the surface leaves free: this share of
/// what a frame's points say about a direction on average. Ours.
constexpr double kSmoothness = 1e-3;
constexpr int kMaxIterations = 120;
constexpr double kRelativeResidual = 1e-4;

/// What the points of one frame on one patch add up to.
struct PatchTerm {
  int patch = 0;
  float weight = 0.0F;
  float residual = 0.0F;                 ///< weighted sum
  Vector6f jacobian = Vector6f::Zero();  ///< weighted sum
};

struct FrameTerm {
  MotionMatrix hessian = MotionMatrix::Zero();
  MotionVector gradient = MotionVector::Zero();
  std::vector<PatchTerm> patches;
};

/// Patches are numbered by their cell, packed into one integer.
std::int64_t cellOf(const Eigen::Vector3f& p) {
  const Eigen::Vector3i cell = (p / kPatch_mm).array().floor().cast<int>() + (1 << 20);
  return (std::int64_t{cell.x()} << 42) | (std::int64_t{cell.y()} << 21) | std::int64_t{cell.z()};
}

}  // namespace

struct PoseAdjustment::State {
  State(std::vector<RigidTransform> start, const Eigen::Vector3d& center, ObserveFrame observe)
      : observe_(std::move(observe)),
        poses_(std::move(start)),
        center_(center),
        terms_(poses_.size()),
        cells_(poses_.size()) {}

  [[nodiscard]] const std::vector<RigidTransform>& poses() const { return poses_; }

  double sweep(double kernel_mm) {
    parallelFor(static_cast<int>(poses_.size()), [&](int i) {
      linearise(static_cast<std::size_t>(i), static_cast<float>(kernel_mm));
    });
    numberPatches();
    const std::vector<MotionVector> steps = solve();
    double largest = 0.0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      poses_[i] = motionOf(steps[i], center_) * poses_[i];
      largest = std::max(largest, (steps[i] - steps[0]).norm());
    }
    updateHeights(steps);
    return largest;
  }

 private:
  [[nodiscard]] float heightOf(std::int64_t cell) const {
    const auto found = numbers_.find(cell);
    return found == numbers_.end() ? 0.0F : heights_[static_cast<std::size_t>(found->second)];
  }

  void linearise(std::size_t i, float kernel) {
    struct Keyed {
      std::int64_t cell;
      float weight, residual;
      Vector6f jacobian;
    };
    const Eigen::Vector3f center = center_.cast<float>();
    constexpr auto kPerLever = static_cast<float>(1.0 / kMotionLever_mm);
    std::vector<Keyed> keyed;
    for (const PoseObservation& seen : observe_(i, poses_[i])) {
      const std::int64_t cell = cellOf(seen.p);
      const float off = (seen.residual_mm - heightOf(cell)) / kernel;
      const float rest = 1.0F - off * off;
      if (rest > 0.0F) {
        Keyed entry{.cell = cell,
                    .weight = seen.weight * rest * rest,
                    .residual = seen.residual_mm,
                    .jacobian = {}};
        entry.jacobian.head<3>() = (seen.p - center).cross(seen.normal) * kPerLever;
        entry.jacobian.tail<3>() = seen.normal;
        keyed.push_back(entry);
      }
    }
    std::stable_sort(
        keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return a.cell < b.cell; });
    FrameTerm term;
    std::vector<std::int64_t>& cells = cells_[i];
    cells.clear();
    for (const Keyed& entry : keyed) {
      if (cells.empty() || cells.back() != entry.cell) {
        cells.push_back(entry.cell);
        term.patches.emplace_back();
      }
      PatchTerm& patch = term.patches.back();
      const Vector6f weighted = entry.weight * entry.jacobian;
      patch.weight += entry.weight;
      patch.residual += entry.weight * entry.residual;
      patch.jacobian += weighted;
      term.hessian.selfadjointView<Eigen::Upper>().rankUpdate(entry.jacobian.cast<double>(),
                                                              static_cast<double>(entry.weight));
      term.gradient += static_cast<double>(entry.residual) * weighted.cast<double>();
    }
    term.hessian = MotionMatrix(term.hessian.selfadjointView<Eigen::Upper>());
    terms_[i] = std::move(term);
  }

  void numberPatches() {
    numbers_.clear();
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      for (std::size_t k = 0; k < terms_[i].patches.size(); ++k) {
        const auto number = static_cast<int>(numbers_.size());
        terms_[i].patches[k].patch = numbers_.try_emplace(cells_[i][k], number).first->second;
      }
    }
    patch_weights_.assign(numbers_.size(), 0.0);
    patch_residuals_.assign(numbers_.size(), 0.0);
    for (const FrameTerm& term : terms_) {
      for (const PatchTerm& patch : term.patches) {
        patch_weights_[static_cast<std::size_t>(patch.patch)] += static_cast<double>(patch.weight);
        patch_residuals_[static_cast<std::size_t>(patch.patch)] +=
            static_cast<double>(patch.residual);
      }
    }
    // The poses' own part of the gradient, with the patches at their best heights.
    double trace = 0.0;
    for (FrameTerm& term : terms_) {
      for (const PatchTerm& patch : term.patches) {
        const auto number = static_cast<std::size_t>(patch.patch);
        term.gradient -=
            patch.jacobian.cast<double>() * (patch_residuals_[number] / patch_weights_[number]);
      }
      trace += term.hessian.trace();
    }
    smoothness_ = kSmoothness * trace / (6.0 * static_cast<double>(terms_.size()));
  }

  /// Reduced normal equations times x.
  [[nodiscard]] std::vector<MotionVector> multiplied(const std::vector<MotionVector>& x) const {
    std::vector<double> patch_motion(patch_weights_.size(), 0.0);
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const Vector6f step = x[i].cast<float>();
      for (const PatchTerm& patch : terms_[i].patches) {
        patch_motion[static_cast<std::size_t>(patch.patch)] +=
            static_cast<double>(patch.jacobian.dot(step));
      }
    }
    for (std::size_t b = 0; b < patch_motion.size(); ++b) {
      patch_motion[b] /= patch_weights_[b];
    }
    std::vector<MotionVector> y(x.size());
    parallelFor(static_cast<int>(x.size()), [&](int frame) {
      const auto i = static_cast<std::size_t>(frame);
      MotionVector sum = terms_[i].hessian * x[i];
      for (const PatchTerm& patch : terms_[i].patches) {
        sum -= patch.jacobian.cast<double>() * patch_motion[static_cast<std::size_t>(patch.patch)];
      }
      if (i > 0) {
        sum += smoothness_ * (x[i] - x[i - 1]);
      }
      if (i + 1 < x.size()) {
        sum += smoothness_ * (x[i] - x[i + 1]);
      }
      y[i] = sum;
    });
    return y;
  }

  static double dot(const std::vector<MotionVector>& a, const std::vector<MotionVector>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      sum += a[i].dot(b[i]);
    }
    return sum;
  }

  /// Conjugate gradients, preconditioned by each frame's own 6 x 6 block. All frames may move
  /// together at no cost; the caller puts the first one back.
  [[nodiscard]] std::vector<MotionVector> solve() const {
    const std::size_t n = terms_.size();
    std::vector<Eigen::LDLT<MotionMatrix>> blocks(n);
    std::vector<MotionVector> r(n);
    for (std::size_t i = 0; i < n; ++i) {
      blocks[i].compute(terms_[i].hessian + 2.0 * smoothness_ * MotionMatrix::Identity());
      r[i] = -terms_[i].gradient;
    }
    const auto precondition = [&](const std::vector<MotionVector>& residual) {
      std::vector<MotionVector> z(n);
      for (std::size_t i = 0; i < n; ++i) {
        z[i] = blocks[i].solve(residual[i]);
      }
      return z;
    };
    std::vector<MotionVector> x(n, MotionVector::Zero());
    std::vector<MotionVector> z = precondition(r);
    std::vector<MotionVector> direction = z;
    double rz = dot(r, z);
    const double enough = kRelativeResidual * kRelativeResidual * rz;
    for (int k = 0; k < kMaxIterations && rz > enough && rz > 0.0; ++k) {
      const std::vector<MotionVector> a_direction = multiplied(direction);
      const double curvature = dot(direction, a_direction);
      if (!(curvature > 0.0)) {
        break;
      }
      const double alpha = rz / curvature;
      for (std::size_t i = 0; i < n; ++i) {
        x[i] += alpha * direction[i];
        r[i] -= alpha * a_direction[i];
      }
      z = precondition(r);
      const double next = dot(r, z);
      const double beta = next / rz;
      rz = next;
      for (std::size_t i = 0; i < n; ++i) {
        direction[i] = z[i] + beta * direction[i];
      }
    }
    return x;
  }

  void updateHeights(const std::vector<MotionVector>& steps) {
    std::vector<double> sums = patch_residuals_;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const Vector6f step = steps[i].cast<float>();
      for (const PatchTerm& patch : terms_[i].patches) {
        sums[static_cast<std::size_t>(patch.patch)] +=
            static_cast<double>(patch.jacobian.dot(step));
      }
    }
    heights_.resize(sums.size());
    for (std::size_t b = 0; b < sums.size(); ++b) {
      heights_[b] = static_cast<float>(sums[b] / patch_weights_[b]);
    }
  }

  ObserveFrame observe_;
  std::vector<RigidTransform> poses_;
  Eigen::Vector3d center_;
  std::vector<FrameTerm> terms_;
  std::vector<std::vector<std::int64_t>> cells_;  ///< of each frame's patches
  std::unordered_map<std::int64_t, int> numbers_;
  std::vector<double> patch_weights_;
  std::vector<double> patch_residuals_;
  std::vector<float> heights_;
  double smoothness_ = 0.0;
};

PoseAdjustment::PoseAdjustment(std::vector<RigidTransform> start,
                               const Eigen::Vector3d& center,
                               ObserveFrame observe)
    : state_(std::make_unique<State>(std::move(start), center, std::move(observe))) {}
PoseAdjustment::~PoseAdjustment() = default;

double PoseAdjustment::sweep(double kernel_mm) { return state_->sweep(kernel_mm); }

const std::vector<RigidTransform>& PoseAdjustment::poses() const { return state_->poses(); }

}  // namespace tarsus
