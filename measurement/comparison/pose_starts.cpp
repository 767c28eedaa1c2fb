#include "measurement/comparison/pose_starts.h"

#include "reconstruction/base/require.h"

#include <array>
#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

/// Axes: outward, then across it towards `hint`.
Eigen::Matrix3d axesOf(const Vector3d& outward, const Vector3d& hint) {
  Eigen::Matrix3d axes;
  axes.col(0) = outward;
  axes.col(1) = (hint - hint.dot(outward) * outward).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

std::vector<RigidTransform> startsFromOutlines(const VisitSkin& a, const VisitSkin& b) {
  constexpr int kTurns = 24;
  std::vector<RigidTransform> starts;
  const Eigen::Matrix3d axes_a = axesOf(a.outward, a.outward.unitOrthogonal());
  const Eigen::Matrix3d axes_b = axesOf(b.outward, b.outward.unitOrthogonal());
  for (int i = 0; i < kTurns; ++i) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * i / kTurns, b.outward);
    RigidTransform b_from_a = RigidTransform::Identity();
    b_from_a.linear() = turn * axes_b * axes_a.transpose();
    b_from_a.translation() = b.wound_mm - b_from_a.linear() * a.wound_mm;
    starts.push_back(b_from_a);
  }
  return starts;
}

std::vector<RigidTransform> startsFromLandmarks(const VisitSkin& a, const VisitSkin& b) {
  if (!a.landmarks || !b.landmarks) {
    return {};
  }
  const std::array points_a{a.landmarks->heel_mm, a.landmarks->toe_mm, a.wound_mm};
  const std::array points_b{b.landmarks->heel_mm, b.landmarks->toe_mm, b.wound_mm};
  RigidTransform b_from_a = RigidTransform::Identity();
  const Eigen::Matrix3d axes_a = axesOf(a.outward, points_a[1] - points_a[0]);
  const Eigen::Matrix3d axes_b = axesOf(b.outward, points_b[1] - points_b[0]);
  b_from_a.linear() = axes_b * axes_a.transpose();
  b_from_a.translation() = b.wound_mm - b_from_a.linear() * a.wound_mm;
  return {b_from_a, fitPoints(points_a, points_b)};
}

RigidTransform fitPoints(std::span<const Vector3d> a, std::span<const Vector3d> b) {
  TARSUS_REQUIRE(a.size() == b.size() && a.size() >= 3, "three or more pairs of points");
  const auto count = static_cast<Eigen::Index>(a.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = a[static_cast<std::size_t>(i)];
    to.col(i) = b[static_cast<std::size_t>(i)];
  }
  RigidTransform b_from_a = RigidTransform::Identity();
  b_from_a.matrix() = Eigen::umeyama(from, to, false);
  return b_from_a;
}

}  // namespace tarsus
