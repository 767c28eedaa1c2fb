#include "reconstruction/capture/calibration/joint_fit.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace tarsus {
namespace {

using Pose = std::array<double, 6>;  ///< angle times axis, then shift [mm]

/// The pixel on which a point before the camera falls (Brown's distortion, as OpenCV orders it).
template <typename T>
void project(const T* lens, const T* p_camera, T* pixel) {
  const T x = p_camera[0] / p_camera[2];
  const T y = p_camera[1] / p_camera[2];
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (lens[4] + r2 * (lens[5] + r2 * lens[8]));
  const T dx = x * radial + 2.0 * lens[6] * x * y + lens[7] * (r2 + 2.0 * x * x);
  const T dy = y * radial + lens[6] * (r2 + 2.0 * y * y) + 2.0 * lens[7] * x * y;
  pixel[0] = lens[0] * dx + lens[2];
  pixel[1] = lens[1] * dy + lens[3];
}

template <typename T>
void move(const T* pose, const T* p, T* result) {
  ceres::AngleAxisRotatePoint(pose, p, result);
  for (int i = 0; i < 3; ++i) {
    result[i] += pose[3 + i];
  }
}

template <typename T>
void moveBack(const T* pose, const T* p, T* result) {
  const T axis[3] = {-pose[0], -pose[1], -pose[2]};
  const T shifted[3] = {p[0] - pose[3], p[1] - pose[4], p[2] - pose[5]};
  ceres::AngleAxisRotatePoint(axis, shifted, result);
}

/// Distance of one corner from its place in the colour image, in standard deviations.
struct ColorCorner {
  Eigen::Vector3d p_board;
  Eigen::Vector2d seen_px;
  double weight;

  template <typename T>
  bool operator()(const T* lens, const T* color_from_board, T* residual) const {
    const T point[3] = {T(p_board.x()), T(p_board.y()), T(p_board.z())};
    T p_camera[3];
    T pixel[2];
    move(color_from_board, point, p_camera);
    project(lens, p_camera, pixel);
    residual[0] = weight * (pixel[0] - seen_px.x());
    residual[1] = weight * (pixel[1] - seen_px.y());
    return true;
  }
};

/// The same in the infrared image of the depth camera.
struct InfraredCorner {
  Eigen::Vector3d p_board;
  Eigen::Vector2d seen_px;
  double weight;

  template <typename T>
  bool operator()(const T* lens,
                  const T* color_from_depth,
                  const T* color_from_board,
                  T* residual) const {
    const T point[3] = {T(p_board.x()), T(p_board.y()), T(p_board.z())};
    T p_color[3];
    T p_camera[3];
    T pixel[2];
    move(color_from_board, point, p_color);
    moveBack(color_from_depth, p_color, p_camera);
    project(lens, p_camera, pixel);
    residual[0] = weight * (pixel[0] - seen_px.x());
    residual[1] = weight * (pixel[1] - seen_px.y());
    return true;
  }
};

Pose poseOf(const RigidTransform& transform) {
  const Eigen::AngleAxisd turn(transform.rotation());
  const Eigen::Vector3d axis = turn.angle() * turn.axis();
  const Eigen::Vector3d shift = transform.translation();
  return {axis.x(), axis.y(), axis.z(), shift.x(), shift.y(), shift.z()};
}

RigidTransform transformOf(const Pose& pose) {
  RigidTransform result = RigidTransform::Identity();
  const Eigen::Vector3d axis(pose[0], pose[1], pose[2]);
  if (axis.norm() > 0.0) {
    result.linear() = Eigen::AngleAxisd(axis.norm(), axis.normalized()).toRotationMatrix();
  }
  result.translation() = Eigen::Vector3d(pose[3], pose[4], pose[5]);
  return result;
}

double rmsOf(const Corners& corners,
             const std::vector<Eigen::Vector3d>& points,
             const LensParameters& lens,
             const RigidTransform& camera_from_board) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d p = camera_from_board * points[i];
    Eigen::Vector2d pixel;
    project(lens.data(), p.data(), pixel.data());
    sum += (pixel - corners[i]).squaredNorm();
  }
  return corners.empty() ? -1.0 : std::sqrt(sum / static_cast<double>(corners.size()));
}

void fillRms(const std::vector<JointView>& views,
             const std::vector<Eigen::Vector3d>& points,
             JointFit& fit) {
  fit.color_rms_px.assign(views.size(), -1.0);
  fit.infrared_rms_px.assign(views.size(), -1.0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (fit.color_from_board[i]) {
      const RigidTransform& pose = *fit.color_from_board[i];
      fit.color_rms_px[i] = rmsOf(views[i].color, points, fit.color, pose);
      fit.infrared_rms_px[i] =
          rmsOf(views[i].infrared, points, fit.depth, fit.color_from_depth.inverse() * pose);
    }
  }
}

/// Noise of one coordinate of a camera's corners [px]; never so small that weights explode.
double noiseOf(const std::vector<double>& rms_px) {
  constexpr double kLeast_px = 1e-4;
  double sum = 0.0;
  int count = 0;
  for (const double rms : rms_px) {
    sum += rms >= 0.0 ? rms * rms : 0.0;
    count += rms >= 0.0 ? 1 : 0;
  }
  return std::max(count > 0 ? std::sqrt(sum / count / 2.0) : 1.0, kLeast_px);
}

/// The blocks that Ceres moves, and the problem made of them.
struct Adjustment {
  LensParameters color;
  LensParameters depth;
  Pose color_from_depth;
  std::vector<Pose> color_from_board;
  ceres::Problem problem;
  bool both = false;

  void holdK3(LensParameters& lens) {
    problem.SetManifold(lens.data(), new ceres::SubsetManifold(9, {8}));
  }
};

void addCorners(Adjustment& adjustment,
                const std::vector<JointView>& views,
                const std::vector<Eigen::Vector3d>& points,
                const JointFit& start) {
  const double color_weight = 1.0 / noiseOf(start.color_rms_px);
  const double depth_weight = 1.0 / noiseOf(start.infrared_rms_px);
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!start.color_from_board[v]) {
      continue;
    }
    double* pose = adjustment.color_from_board[v].data();
    for (std::size_t i = 0; i < views[v].color.size(); ++i) {
      adjustment.problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ColorCorner, 2, 9, 6>(
              new ColorCorner{points[i], views[v].color[i], color_weight}),
          nullptr,
          adjustment.color.data(),
          pose);
    }
    for (std::size_t i = 0; i < views[v].infrared.size(); ++i) {
      adjustment.both = true;
      adjustment.problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<InfraredCorner, 2, 9, 6, 6>(
              new InfraredCorner{points[i], views[v].infrared[i], depth_weight}),
          nullptr,
          adjustment.depth.data(),
          adjustment.color_from_depth.data(),
          pose);
    }
  }
  if (!start.color_k3_free) {
    adjustment.holdK3(adjustment.color);
  }
  if (adjustment.both && !start.depth_k3_free) {
    adjustment.holdK3(adjustment.depth);
  }
}

/// Square roots of the covariance's diagonal, as the residuals scale it.
template <std::size_t N>
std::array<double, N> deviations(const ceres::Covariance& covariance,
                                 const double* block,
                                 double scale) {
  std::array<double, N * N> square{};
  std::array<double, N> result{};
  if (covariance.GetCovarianceBlock(block, block, square.data())) {
    for (std::size_t i = 0; i < N; ++i) {
      result[i] = scale * std::sqrt(std::max(square[i * N + i], 0.0));
    }
  }
  return result;
}

bool fillDeviations(Adjustment& adjustment, const ceres::Solver::Summary& summary, JointFit& fit) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  std::vector<const double*> blocks{adjustment.color.data()};
  if (adjustment.both) {
    blocks.push_back(adjustment.depth.data());
    blocks.push_back(adjustment.color_from_depth.data());
  }
  std::vector<std::pair<const double*, const double*>> pairs;
  pairs.reserve(blocks.size());
  for (const double* block : blocks) {
    pairs.emplace_back(block, block);
  }
  if (!covariance.Compute(pairs, &adjustment.problem)) {
    return false;
  }
  const int freedom = summary.num_residuals_reduced - summary.num_effective_parameters_reduced;
  const double scale = std::sqrt(2.0 * summary.final_cost / std::max(freedom, 1));
  fit.color_deviation = deviations<9>(covariance, adjustment.color.data(), scale);
  if (adjustment.both) {
    fit.depth_deviation = deviations<9>(covariance, adjustment.depth.data(), scale);
    const auto pose = deviations<6>(covariance, adjustment.color_from_depth.data(), scale);
    fit.rotation_deviation_rad = {pose[0], pose[1], pose[2]};
    fit.translation_deviation_mm = {pose[3], pose[4], pose[5]};
  }
  return true;
}

}  // namespace

std::optional<JointFit> adjustJointly(const std::vector<JointView>& views,
                                      const Chessboard& board,
                                      JointFit start) {
  const std::vector<Eigen::Vector3d> points = boardPoints(board);
  fillRms(views, points, start);
  Adjustment adjustment{.color = start.color,
                        .depth = start.depth,
                        .color_from_depth = poseOf(start.color_from_depth),
                        .color_from_board = {},
                        .problem = {},
                        .both = false};
  for (const auto& pose : start.color_from_board) {
    adjustment.color_from_board.push_back(poseOf(pose.value_or(RigidTransform::Identity())));
  }
  addCorners(adjustment, views, points, start);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-12;
  options.num_threads = 1;  // the same bits on every machine
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &adjustment.problem, &summary);
  JointFit fit = std::move(start);
  fit.color = adjustment.color;
  fit.depth = adjustment.depth;
  fit.color_from_depth = transformOf(adjustment.color_from_depth);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (fit.color_from_board[i]) {
      fit.color_from_board[i] = transformOf(adjustment.color_from_board[i]);
    }
  }
  fillRms(views, points, fit);
  if (!summary.IsSolutionUsable() || !fillDeviations(adjustment, summary, fit)) {
    return std::nullopt;
  }
  return fit;
}

}  // namespace tarsus
