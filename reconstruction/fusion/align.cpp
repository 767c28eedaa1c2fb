#include "reconstruction/fusion/align.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/rigid_motion.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr int kPointsPerTask = 2048;
/// A direction counts as fixed when the points' mean squared sensitivity along it (1 = all
/// normals point that way) is above this. Ours.
constexpr double kFreeDirection = 1e-3;
constexpr double kLargestStep_mm = 30.0;
/// Steeper than 73 degrees, a coded-light reading errs too much. Less steep limits lose what fixes
/// the camera sideways: poses were worse by a third at 66 degrees.
constexpr float kLeastCosine = 0.3F;
/// A step along the ray stays well within the band in which the field is known.
constexpr double kShareOfBand = 0.6;

/// What one pass over the points adds up.
struct Sums {
  MotionMatrix hessian = MotionMatrix::Zero();  ///< upper triangle
  MotionVector gradient = MotionVector::Zero();
  double weight = 0.0;         ///< of all points
  double active_weight = 0.0;  ///< of those in the equations
  double cost = 0.0;
  double squares = 0.0;
  int known = 0;
  int inliers = 0;

  void add(const Sums& other) {
    hessian += other.hessian;
    gradient += other.gradient;
    weight += other.weight;
    active_weight += other.active_weight;
    cost += other.cost;
    squares += other.squares;
    known += other.known;
    inliers += other.inliers;
  }
};

/// 21 + 6 sums in float are exact enough for one task's points, and four times faster.
struct TaskSums {
  std::array<float, 21> hessian{};
  Eigen::Matrix<float, 6, 1> gradient = Eigen::Matrix<float, 6, 1>::Zero();

  void add(const Eigen::Matrix<float, 6, 1>& j, float residual, float weight) {
    std::size_t k = 0;
    for (int row = 0; row < 6; ++row) {
      const float scaled = weight * j[row];
      for (int column = row; column < 6; ++column) {
        hessian[k++] += scaled * j[column];
      }
    }
    gradient += (weight * residual) * j;
  }
  void addTo(Sums& sums) const {
    std::size_t k = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        sums.hessian(row, column) += static_cast<double>(hessian[k++]);
      }
    }
    sums.gradient += gradient.cast<double>();
  }
};

class Aligner {
 public:
  Aligner(const TsdfVolume& field,
          std::span<const AlignmentPoint> points,
          const AlignmentOptions& options)
      : field_(field), points_(points), options_(options) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const AlignmentPoint& point : points) {
      sum += point.p_camera.cast<double>();
    }
    center_camera_ = sum / std::max<double>(1.0, static_cast<double>(points.size()));
  }

  AlignmentResult run(const RigidTransform& start) const {
    RigidTransform pose = start;
    Sums sums = evaluate(pose);
    AlignmentResult best = describe(pose, sums);
    for (int i = 0; i < options_.max_iterations && sums.known >= 6; ++i) {
      int free_directions = 0;
      const MotionVector step = solve(sums, free_directions);
      const RigidTransform candidate = moved(pose, step);
      sums = evaluate(candidate);
      AlignmentResult result = describe(candidate, sums);
      result.free_directions = free_directions;
      // The cost may rise for a while, when points enter the field: go on, but keep the best.
      if (result.cost_mm2 < best.cost_mm2) {
        best = result;
      }
      best.free_directions = free_directions;
      pose = candidate;
      if (stepLength(step) < options_.stop_step_mm) {
        break;
      }
    }
    return best;
  }

 private:
  [[nodiscard]] Sums evaluate(const RigidTransform& pose) const {
    const int count = static_cast<int>(points_.size());
    const int tasks = (count + kPointsPerTask - 1) / kPointsPerTask;
    std::vector<Sums> partial(static_cast<std::size_t>(tasks));
    parallelFor(tasks, [&](int task) {
      const auto first = static_cast<std::size_t>(task * kPointsPerTask);
      const auto n = std::min<std::size_t>(kPointsPerTask, points_.size() - first);
      partial[static_cast<std::size_t>(task)] = evaluateSome(pose, points_.subspan(first, n));
    });
    Sums total;
    for (const Sums& sums : partial) {
      total.add(sums);
    }
    return total;
  }

  [[nodiscard]] Sums evaluateSome(const RigidTransform& pose,
                                  std::span<const AlignmentPoint> points) const {
    const Eigen::Matrix3f rotation = pose.linear().cast<float>();
    const Eigen::Vector3f translation = pose.translation().cast<float>();
    const Eigen::Vector3f center = (pose * center_camera_).cast<float>();
    const auto kernel = static_cast<float>(options_.kernel_mm);
    const auto inlier = static_cast<float>(options_.inlier_mm);
    constexpr auto kPerLever = static_cast<float>(1.0 / kMotionLever_mm);
    TaskSums equations;
    Sums sums;
    for (const AlignmentPoint& point : points) {
      sums.weight += static_cast<double>(point.weight);
      const Eigen::Vector3f p = rotation * point.p_camera + translation;
      SdfSample sample;
      if (!field_.sample(p, sample)) {
        sums.cost += static_cast<double>(point.weight * kernel * kernel);
        continue;
      }
      const float r = sample.distance_mm;
      ++sums.known;
      sums.inliers += std::abs(r) <= inlier ? 1 : 0;
      sums.squares += static_cast<double>(r * r);
      const float u = std::min(1.0F, r * r / (kernel * kernel));
      const float rest = 1.0F - u;
      sums.cost +=
          static_cast<double>(point.weight * kernel * kernel * (1.0F - rest * rest * rest));
      if (rest <= 0.0F) {
        continue;
      }
      SdfSample smoother;
      if (options_.gradient_field != nullptr && options_.gradient_field->sample(p, smoother)) {
        sample.gradient = smoother.gradient;
      }
      const float weight = point.weight * rest * rest;  // Tukey's biweight
      Eigen::Matrix<float, 6, 1> j;
      j.head<3>() = (p - center).cross(sample.gradient) * kPerLever;
      j.tail<3>() = sample.gradient;
      equations.add(j, r, weight);
      sums.active_weight += static_cast<double>(weight);
    }
    equations.addTo(sums);
    return sums;
  }

  [[nodiscard]] AlignmentResult describe(const RigidTransform& pose, const Sums& sums) const {
    AlignmentResult result;
    result.scan_from_camera = pose;
    const double count = std::max<double>(1.0, static_cast<double>(points_.size()));
    result.rmse_mm = sums.known > 0 ? std::sqrt(sums.squares / sums.known) : options_.kernel_mm;
    result.inlier_fraction = static_cast<double>(sums.inliers) / count;
    result.known_fraction = static_cast<double>(sums.known) / count;
    result.cost_mm2 = sums.weight > 0.0 ? sums.cost / sums.weight : 0.0;
    return result;
  }

  /// Solves in the eigenvectors of the normal equations and leaves weak ones alone.
  static MotionVector solve(const Sums& sums, int& free_directions) {
    const MotionMatrix hessian = sums.hessian.selfadjointView<Eigen::Upper>();
    const Eigen::SelfAdjointEigenSolver<MotionMatrix> eigen(hessian /
                                                            std::max(sums.active_weight, 1e-9));
    const MotionVector along =
        eigen.eigenvectors().transpose() * (sums.gradient / std::max(sums.active_weight, 1e-9));
    MotionVector step = MotionVector::Zero();
    free_directions = 0;
    for (int i = 0; i < 6; ++i) {
      if (eigen.eigenvalues()[i] < kFreeDirection) {
        ++free_directions;
        continue;
      }
      step -= eigen.eigenvectors().col(i) * (along[i] / eigen.eigenvalues()[i]);
    }
    const double length = stepLength(step);
    return length > kLargestStep_mm ? MotionVector(step * (kLargestStep_mm / length)) : step;
  }

  static double stepLength(const MotionVector& step) {
    return step.head<3>().norm() + step.tail<3>().norm();
  }

  /// Turned about the points' centre and shifted; a scan adds up thousands of these, so the turn is
  /// made a proper one again.
  [[nodiscard]] RigidTransform moved(const RigidTransform& pose, const MotionVector& step) const {
    RigidTransform result = motionOf(step, pose * center_camera_) * pose;
    result.linear() = Eigen::Quaterniond(result.linear()).normalized().toRotationMatrix();
    return result;
  }

  const TsdfVolume& field_;
  std::span<const AlignmentPoint> points_;
  AlignmentOptions options_;
  Eigen::Vector3d center_camera_;
};

}  // namespace

std::optional<RayOnSurface> meetSurface(const TsdfVolume& field,
                                        const Eigen::Isometry3f& scan_from_camera,
                                        const Eigen::Vector3f& p_camera) {
  const Eigen::Vector3f measured = scan_from_camera * p_camera;
  const Eigen::Vector3f ray = scan_from_camera.linear() * p_camera.normalized();
  SdfSample sample;
  if (!field.sample(measured, sample)) {
    return std::nullopt;
  }
  const float approach = -sample.gradient.dot(ray);
  const double reach_mm = kShareOfBand * field.options().weighting.delta_mm;
  if (approach < kLeastCosine || static_cast<double>(std::abs(sample.distance_mm)) >
                                     reach_mm * static_cast<double>(approach)) {
    return std::nullopt;
  }
  // One step of Newton's; what is left of it enters the residual.
  RayOnSurface result{.p = measured + ray * (sample.distance_mm / approach)};
  if (!field.sample(result.p, sample)) {
    return std::nullopt;
  }
  const float length = sample.gradient.norm();
  result.normal = sample.gradient / std::max(length, 1e-6F);
  result.cosine = -result.normal.dot(ray);
  result.residual_mm =
      sample.distance_mm / std::max(length, 0.5F) + result.normal.dot(measured - result.p);
  return result.cosine < kLeastCosine ? std::nullopt : std::optional(result);
}

float certaintyAt(float z_mm) {
  const float noise = (0.15F + 0.0006F * z_mm) / 0.36F;
  return 1.0F / (noise * noise);
}

std::vector<AlignmentPoint> alignmentPoints(const DepthPlanes& planes, int stride) {
  const Intrinsics& k = planes.intrinsics;
  std::vector<AlignmentPoint> points;
  for (int v = stride / 2; v < k.height; v += stride) {
    for (int u = stride / 2; u < k.width; u += stride) {
      const std::size_t i = planes.index(u, v);
      if (planes.quality[i] <= 0.0F) {
        continue;
      }
      const float z = planes.depth_mm[i];
      points.push_back({k.ray(u, v).cast<float>() * z, planes.quality[i] * certaintyAt(z)});
    }
  }
  return points;
}

AlignmentResult alignToField(const TsdfVolume& field,
                             std::span<const AlignmentPoint> points,
                             const RigidTransform& start,
                             const AlignmentOptions& options) {
  return Aligner(field, points, options).run(start);
}

}  // namespace tarsus
