#include "reconstruction/fusion/visit_alignment.h"

#include "reconstruction/base/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace tarsus {
namespace {

using Eigenvectors = Eigen::SelfAdjointEigenSolver<MotionMatrix>;

/// A direction counts as fixed when the points' mean squared sensitivity along it (1 = all normals
/// point that way) is above this. The noise of the coarse field's normals looks like 0.004 on a
/// bare wall, far from its middle; the weakest direction of a foot has 0.016 or more. Ours.
constexpr double kFreeDirection = 6e-3;
/// Tukey's kernel from step to step, once the field's values have done what they can.
constexpr std::array<float, 4> kKernels_mm{4.0F, 2.0F, 1.2F, 1.2F};

/// What a pass over the points adds up.
struct Sums {
  MotionMatrix hessian = MotionMatrix::Zero();
  MotionVector gradient = MotionVector::Zero();
  double weight = 0.0;
  double squares = 0.0;
  int points = 0;
  int met = 0;
  int inliers = 0;

  void add(const Sums& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    weight += other.weight;
    squares += other.squares;
    points += other.points;
    met += other.met;
    inliers += other.inliers;
  }
};

MotionVector vectorOf(const RigidTransform& motion, const Eigen::Vector3d& center) {
  const Eigen::AngleAxisd turn(motion.linear());
  MotionVector vector;
  vector.head<3>() = turn.angle() * kMotionLever_mm * turn.axis();
  vector.tail<3>() = motion * center - center;
  return vector;
}

TsdfOptions volumeOptions(const LoopMeasureOptions& options,
                          double voxel_size_mm,
                          const TsdfWeighting& weighting) {
  return {.voxel_size_mm = voxel_size_mm,
          .weighting = weighting,
          .min_depth_mm = options.min_depth_mm,
          .max_depth_mm = options.max_depth_mm,
          .max_depth_ratio = options.max_depth_ratio,
          .with_color = false};
}

/// Moves the later visit as one rigid body.
class VisitAligner {
 public:
  VisitAligner(const VisitedPlace& place,
               const std::vector<VisitFrame>& window,
               const RigidTransform& scan_from_later,
               const LoopMeasureOptions& options)
      : place_(place), window_(window), scan_from_later_(scan_from_later), options_(options) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (const VisitFrame& frame : window_) {
      for (const AlignmentPoint& point : frame.points) {
        sum += frame.scan_from_camera * point.p_camera.cast<double>();
        count += 1.0;
      }
    }
    center_ = sum / std::max(1.0, count);
  }

  VisitAlignment run() {
    onValues();
    findHeldDirections();
    for (const float kernel : kKernels_mm) {
      sums_ = evaluate(kernel);
      step();
    }
    sums_ = evaluate(kKernels_mm.back());
    return described();
  }

 private:
  /// By value and gradient of the fields: reaches far, not to the last tenth.
  void onValues() {
    std::size_t count = 0;
    for (const VisitFrame& frame : window_) {
      count += frame.points.size();
    }
    const std::size_t stride = strideFor(count, options_.most_points_at_first);
    FramePoints some;
    const RigidTransform later_from_scan = scan_from_later_.inverse();
    for (const VisitFrame& frame : window_) {
      const Eigen::Isometry3f later_from_camera =
          (later_from_scan * frame.scan_from_camera).cast<float>();
      for (std::size_t k = frame.index % stride; k < frame.points.size(); k += stride) {
        some.push_back({later_from_camera * frame.points[k].p_camera, frame.points[k].weight});
      }
    }
    AlignmentResult result = alignToField(place_.coarse,
                                          some,
                                          scan_from_later_,
                                          {.max_iterations = 15,
                                           .kernel_mm = options_.coarse_weighting.delta_mm,
                                           .inlier_mm = options_.inlier_mm,
                                           .stop_step_mm = 0.3});
    result = alignToField(place_.fine,
                          some,
                          result.scan_from_camera,
                          {.max_iterations = 5,
                           .kernel_mm = options_.weighting.delta_mm,
                           .inlier_mm = options_.inlier_mm,
                           .stop_step_mm = 0.1,
                           .gradient_field = &place_.coarse});
    motion_ = result.scan_from_camera * later_from_scan;
  }

  [[nodiscard]] Sums evaluate(float kernel) const {
    std::vector<Sums> partial(window_.size());
    parallelFor(static_cast<int>(window_.size()), [&](int k) {
      partial[static_cast<std::size_t>(k)] =
          evaluateFrame(window_[static_cast<std::size_t>(k)], kernel);
    });
    Sums total;
    for (const Sums& sums : partial) {
      total.add(sums);
    }
    total.hessian = MotionMatrix(total.hessian.selfadjointView<Eigen::Upper>());
    return total;
  }

  [[nodiscard]] Sums evaluateFrame(const VisitFrame& frame, float kernel) const {
    const Eigen::Isometry3f pose = (motion_ * frame.scan_from_camera).cast<float>();
    const Eigen::Vector3d center = motion_ * center_;
    Sums sums;
    sums.points = static_cast<int>(frame.points.size());
    for (const AlignmentPoint& point : frame.points) {
      const std::optional<RayOnSurface> hit = meetSurface(place_.fine, pose, point.p_camera);
      if (!hit) {
        continue;
      }
      const float off = hit->residual_mm / kernel;
      const float rest = 1.0F - off * off;
      ++sums.met;
      sums.inliers += std::abs(hit->residual_mm) <= static_cast<float>(options_.inlier_mm) ? 1 : 0;
      if (rest <= 0.0F) {
        continue;
      }
      const auto weight =
          static_cast<double>(certaintyAt(point.p_camera.z()) * hit->cosine * rest * rest);
      const auto residual = static_cast<double>(hit->residual_mm);
      const MotionVector j =
          sensitivity(hit->p.cast<double>() - center, hit->normal.cast<double>());
      sums.hessian.selfadjointView<Eigen::Upper>().rankUpdate(j, weight);
      sums.gradient += weight * residual * j;
      sums.weight += weight;
      sums.squares += weight * residual * residual;
    }
    return sums;
  }

  /// Which directions the surface fixes. Noise in the fine field's normals looks like information
  /// (7 degrees: 0.015 along a bare wall); the coarse field averages four times as many pixels.
  void findHeldDirections() {
    std::vector<Sums> partial(window_.size());
    parallelFor(static_cast<int>(window_.size()), [&](int k) {
      const VisitFrame& frame = window_[static_cast<std::size_t>(k)];
      const Eigen::Isometry3f pose = (motion_ * frame.scan_from_camera).cast<float>();
      const Eigen::Vector3d center = motion_ * center_;
      Sums& sums = partial[static_cast<std::size_t>(k)];
      SdfSample sample;
      for (const AlignmentPoint& point : frame.points) {
        const Eigen::Vector3f p = pose * point.p_camera;
        if (!place_.coarse.sample(p, sample) ||
            std::abs(sample.distance_mm) > kKernels_mm.front()) {
          continue;
        }
        const auto weight = static_cast<double>(point.weight);
        const MotionVector j =
            sensitivity(p.cast<double>() - center, sample.gradient.normalized().cast<double>());
        sums.hessian.selfadjointView<Eigen::Upper>().rankUpdate(j, weight);
        sums.weight += weight;
      }
    });
    Sums total;
    for (const Sums& sums : partial) {
      total.add(sums);
    }
    const Eigenvectors eigen(MotionMatrix(total.hessian.selfadjointView<Eigen::Upper>()) /
                             std::max(total.weight, 1e-9));
    // Eigenvalues are sorted, the least first.
    const auto free = std::ranges::count_if(eigen.eigenvalues(),
                                            [](double value) { return value < kFreeDirection; });
    held_ = eigen.eigenvectors().rightCols(6 - free);
  }

  static MotionVector sensitivity(const Eigen::Vector3d& from_center,
                                  const Eigen::Vector3d& normal) {
    MotionVector j;
    j.head<3>() = from_center.cross(normal) / kMotionLever_mm;
    j.tail<3>() = normal;
    return j;
  }

  void step() {
    if (held_.cols() == 0 || !(sums_.weight > 0.0)) {
      return;
    }
    const Eigen::MatrixXd held_hessian = held_.transpose() * sums_.hessian * held_;
    const MotionVector step =
        -held_ * held_hessian.ldlt().solve(held_.transpose() * sums_.gradient);
    motion_ = motionOf(step, motion_ * center_) * motion_;
  }

  [[nodiscard]] VisitAlignment described() const {
    const MotionMatrix keep = held_ * held_.transpose();
    VisitAlignment result;
    // What the steps moved along directions that the surface does not fix is no measurement.
    result.motion = motionOf(keep * vectorOf(motion_, center_), center_);
    result.center = center_;
    result.sensitivity = keep * sums_.hessian * keep / std::max(sums_.weight, 1e-9);
    result.free_directions = static_cast<int>(6 - held_.cols());
    result.inlier_fraction = static_cast<double>(sums_.inliers) / std::max(1, sums_.met);
    result.shared_fraction = static_cast<double>(sums_.met) / std::max(1, sums_.points);
    result.rmse_mm = std::sqrt(sums_.squares / std::max(sums_.weight, 1e-9));
    return result;
  }

  const VisitedPlace& place_;
  const std::vector<VisitFrame>& window_;
  RigidTransform scan_from_later_;
  const LoopMeasureOptions& options_;
  Eigen::Vector3d center_;  ///< of the points before they are moved, scan frame
  RigidTransform motion_ = RigidTransform::Identity();
  Sums sums_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> held_;  ///< directions that the surface fixes
};

}  // namespace

VisitedPlace::VisitedPlace(const ScanArchive& frames,
                           const Trajectory& trajectory,
                           std::span<const std::size_t> window,
                           const LoopMeasureOptions& options)
    : coarse(volumeOptions(options, options.coarse_voxel_size_mm, options.coarse_weighting)),
      fine(volumeOptions(options, options.voxel_size_mm, options.weighting)) {
  std::vector<DepthPlanes> planes(window.size());
  parallelFor(static_cast<int>(window.size()), [&](int k) {
    const RgbdFrame frame = frames.frame(static_cast<int>(window[static_cast<std::size_t>(k)]));
    planes[static_cast<std::size_t>(k)] =
        fitDepthPlanes(frames.camera().depth,
                       frame.depth,
                       {.min_depth_mm = options.min_depth_mm,
                        .max_depth_mm = options.max_depth_mm,
                        .max_depth_ratio = options.max_depth_ratio});
  });
  const ColorImage none;
  for (std::size_t k = 0; k < window.size(); ++k) {
    const RigidTransform& pose = *trajectory[window[k]].scan_from_camera;
    coarse.integrate(frames.camera(), planes[k], none, pose);
    fine.integrate(frames.camera(), planes[k], none, pose);
  }
}

VisitAlignment alignVisit(const VisitedPlace& place,
                          const std::vector<VisitFrame>& visit,
                          const RigidTransform& scan_from_later,
                          const LoopMeasureOptions& options) {
  return VisitAligner(place, visit, scan_from_later, options).run();
}

std::size_t strideFor(std::size_t count, int most) {
  return std::max<std::size_t>(1, count / static_cast<std::size_t>(std::max(1, most)));
}

}  // namespace tarsus
