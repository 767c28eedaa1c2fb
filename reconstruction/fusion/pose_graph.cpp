#include "reconstruction/fusion/pose_graph.h"

#include "reconstruction/base/require.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <memory>

namespace tarsus {
namespace {

/// A pose as Ceres turns it: quaternion (x, y, z, w) and translation [mm].
struct Node {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
};

class EdgeError {
 public:
  explicit EdgeError(const PoseEdge& edge) : edge_(edge), b_from_a_(edge.a_from_b.inverse()) {}

  template <typename T>
  bool operator()(const T* rotation_a,
                  const T* translation_a,
                  const T* rotation_b,
                  const T* translation_b,
                  T* residual) const {
    using Vector3 = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> q_a(rotation_a);
    const Eigen::Map<const Eigen::Quaternion<T>> q_b(rotation_b);
    const Eigen::Map<const Vector3> t_a(translation_a);
    const Eigen::Map<const Vector3> t_b(translation_b);
    const Eigen::Quaternion<T> measured(Eigen::Quaterniond(b_from_a_.linear()).cast<T>());
    const Eigen::Quaternion<T> turn = measured * q_a.conjugate() * q_b;
    const Vector3 center = edge_.center_b.cast<T>();
    const Vector3 center_a = q_a.conjugate() * Vector3(q_b * center + t_b - t_a);
    const Vector3 center_b = measured * center_a + b_from_a_.translation().cast<T>();
    const T wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
    Eigen::Matrix<T, 6, 1> motion;
    ceres::QuaternionToAngleAxis(wxyz, motion.data());
    motion.template head<3>() *= T(kMotionLever_mm);
    motion.template tail<3>() = center_b - center;
    Eigen::Map<Eigen::Matrix<T, 6, 1>> whitened(residual);
    whitened = edge_.sqrt_information.cast<T>() * motion;
    return true;
  }

 private:
  PoseEdge edge_;
  RigidTransform b_from_a_;
};

using EdgeCost = ceres::AutoDiffCostFunction<EdgeError, 6, 4, 3, 4, 3>;

double whitenedLength(const PoseEdge& edge, const std::vector<Node>& nodes) {
  const Node& a = nodes[edge.a];
  const Node& b = nodes[edge.b];
  MotionVector residual;
  const EdgeError error(edge);
  error(a.rotation.coeffs().data(),
        a.translation.data(),
        b.rotation.coeffs().data(),
        b.translation.data(),
        residual.data());
  return residual.norm();
}

void solve(std::vector<Node>& nodes,
           std::span<const PoseEdge> edges,
           const PoseGraphOptions& options) {
  ceres::Problem problem;
  for (Node& node : nodes) {
    problem.AddParameterBlock(
        node.rotation.coeffs().data(), 4, new ceres::EigenQuaternionManifold());
    problem.AddParameterBlock(node.translation.data(), 3);
  }
  for (const PoseEdge& edge : edges) {
    Node& a = nodes[edge.a];
    Node& b = nodes[edge.b];
    problem.AddResidualBlock(
        new EdgeCost(new EdgeError(edge)),
        edge.may_be_false ? new ceres::CauchyLoss(options.robust_scale) : nullptr,
        a.rotation.coeffs().data(),
        a.translation.data(),
        b.rotation.coeffs().data(),
        b.translation.data());
  }
  problem.SetParameterBlockConstant(nodes.front().rotation.coeffs().data());
  problem.SetParameterBlockConstant(nodes.front().translation.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // SuiteSparse would call a BLAS that may use as many threads as it likes.
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  solver.num_threads = 1;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-9;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  TARSUS_REQUIRE(summary.IsSolutionUsable(), "poses and edges are finite");
}

}  // namespace

std::vector<RigidTransform> solvePoseGraph(std::span<const RigidTransform> start,
                                           std::span<const PoseEdge> edges,
                                           const PoseGraphOptions& options) {
  std::vector<RigidTransform> poses(start.begin(), start.end());
  std::vector<Node> nodes;
  nodes.reserve(start.size());
  for (const RigidTransform& pose : start) {
    nodes.push_back({Eigen::Quaterniond(pose.linear()).normalized(), pose.translation()});
  }
  if (nodes.size() < 2) {
    return poses;
  }
  solve(nodes, edges, options);
  std::vector<PoseEdge> believed;
  for (const PoseEdge& edge : edges) {
    if (!edge.may_be_false || whitenedLength(edge, nodes) <= options.false_beyond) {
      believed.push_back(edge);
    }
  }
  if (believed.size() < edges.size()) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i] = {Eigen::Quaterniond(start[i].linear()).normalized(), start[i].translation()};
    }
    solve(nodes, believed, options);
  }
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    poses[i].linear() = nodes[i].rotation.normalized().toRotationMatrix();
    poses[i].translation() = nodes[i].translation;
  }
  return poses;
}

}  // namespace tarsus
