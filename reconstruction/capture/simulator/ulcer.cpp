#include "reconstruction/capture/simulator/ulcer.h"

#include "reconstruction/capture/simulator/random.h"
#include "reconstruction/capture/simulator/solid_noise.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tarsus {

using Eigen::Vector2d;
using Eigen::Vector3d;

Ulcer::Ulcer(const UlcerDesign& design,
             const Vector3d& center,
             const Vector3d& axis,
             const Vector3d& heel_toe,
             std::uint64_t stream)
    : design_(design), center_(center), axis_(axis.normalized()), stream_(stream) {
  u_ = (heel_toe - heel_toe.dot(axis_) * axis_).normalized();
  v_ = axis_.cross(u_);
  for (int k = 0; k < kHarmonics; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double random = uniformFrom(randomBits(stream, static_cast<std::uint64_t>(2 * k)));
    amplitude_[i] = design.irregularity * (0.6 + 0.8 * random) / (k + 1.5);
    phase_[i] = 2.0 * std::numbers::pi *
                uniformFrom(randomBits(stream, static_cast<std::uint64_t>(2 * k + 1)));
  }
  for (int i = 0; i < 360; ++i) {
    reach_mm_ = std::max(reach_mm_, rimRadius(i * std::numbers::pi / 180.0));
  }
}

Vector3d Ulcer::local(const Vector3d& p) const {
  const Vector3d r = p - center_;
  return {r.dot(u_), r.dot(v_), r.dot(axis_)};
}

Vector3d Ulcer::worldDirection(const Vector2d& in_plane) const {
  return in_plane.x() * u_ + in_plane.y() * v_;
}

bool Ulcer::isNear(const Vector3d& p, double margin_mm) const {
  // Thin parts (a toe) have skin on the far side too: that is deeper than any rim lies.
  const Vector3d q = local(p);
  return q.head<2>().norm() < reach_mm_ + margin_mm && q.z() > -0.75 * reach_mm_ - margin_mm &&
         q.z() < 0.75 * reach_mm_ + margin_mm;
}

double Ulcer::rimRadius(double angle) const {
  const double t = angle - design_.turn_rad;
  const double ellipse =
      1.0 / std::hypot(std::cos(t) / design_.half_length_mm, std::sin(t) / design_.half_width_mm);
  double factor = 1.0;
  for (int k = 0; k < kHarmonics; ++k) {
    const auto i = static_cast<std::size_t>(k);
    factor += amplitude_[i] * std::cos((k + 2) * angle + phase_[i]);
  }
  return ellipse * factor;
}

double Ulcer::rimDistance(const Vector3d& p) const {
  const Vector3d q = local(p);
  const double angle = std::atan2(q.y(), q.x());
  const double radius = rimRadius(angle);
  constexpr double kStep = 1e-3;
  const double slope = (rimRadius(angle + kStep) - rimRadius(angle - kStep)) / (2.0 * kStep);
  return (q.head<2>().norm() - radius) / std::hypot(1.0, slope / radius);
}

double Ulcer::islandShare(const Vector3d& q) const {
  double share = 0.0;
  for (int i = 0; i < design_.islands; ++i) {
    const auto random = [&](int k) {
      return uniformFrom(randomBits(stream_ + 77, static_cast<std::uint64_t>(4 * i + k)));
    };
    const double angle = 2.0 * std::numbers::pi * random(0);
    const double radius = rimRadius(angle) * (0.35 + 0.25 * random(1));
    const Vector2d middle(radius * std::cos(angle), radius * std::sin(angle));
    const double size_mm = 1.1 + 0.8 * random(2);
    share = std::max(share,
                     std::exp(-0.5 * (q.head<2>() - middle).squaredNorm() / (size_mm * size_mm)));
  }
  return share;
}

double Ulcer::depth(const Vector3d& p) const {
  if (!isNear(p, 0.0)) {
    return 0.0;
  }
  const double inside_mm = -rimDistance(p);
  if (inside_mm <= 0.0) {
    return 0.0;
  }
  Vector3d q = local(p);
  q.z() = 0.0;
  const double wall = 1.0 - std::exp(-inside_mm / design_.wall_mm);
  const double bowl = 0.82 + 0.18 * smoothStep(0.0, 0.9 * design_.half_width_mm, inside_mm);
  // Undulation at the scale of the wound, and granulation buds about 2 mm wide.
  const double bed = 1.0 + design_.undulation * fractalNoise(q / 7.0, 2, stream_ + 11) +
                     (0.12 / design_.depth_mm) * solidNoise(q / 1.3, stream_ + 12);
  return design_.depth_mm * wall * bowl * std::max(bed, 0.3) * (1.0 - 0.85 * islandShare(q));
}

}  // namespace tarsus
