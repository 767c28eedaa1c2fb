#include "reconstruction/capture/simulator/visit.h"

#include "reconstruction/capture/simulator/foot_shape.h"
#include "reconstruction/capture/simulator/random.h"
#include "reconstruction/capture/simulator/ulcer_designs.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Where the foot turns on its bench: the heel rests.
const Vector3d kHeel_mm{40.0, 0.0, 40.0};

/// Rim and bed of the same ulcer later; bed and islands keep their pattern.
UlcerDesign later(UlcerDesign design, const SimulatorOptions& options) {
  const double shrink = std::sqrt(options.area_factor);
  design.half_length_mm *= shrink;
  design.half_width_mm *= shrink;
  design.depth_mm *= options.depth_factor;
  design.wall_mm *= std::min(1.0, shrink);
  return design;
}

/// New skin has grown across the middle: a part at each end of the long axis.
std::array<UlcerDesign, 2> halves(const UlcerDesign& whole) {
  constexpr double kAside = 0.56;  // of the half length
  constexpr double kLengthOfHalf = 0.4;
  constexpr double kWidthOfHalf = 0.8;
  const Vector3d axis = -whole.seen_towards.normalized();
  const Vector3d u = (Vector3d::UnitX() - axis.x() * axis).normalized();
  const Vector3d along = std::cos(whole.turn_rad) * u + std::sin(whole.turn_rad) * axis.cross(u);
  std::array<UlcerDesign, 2> parts{whole, whole};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double side = i == 0 ? kAside : -kAside;
    parts[i].seen_from += side * whole.half_length_mm * along;
    parts[i].half_length_mm *= kLengthOfHalf;
    parts[i].half_width_mm *= kWidthOfHalf;
    parts[i].islands = 0;
    parts[i].site += i == 0 ? ", first part" : ", second part";
  }
  return parts;
}

}  // namespace

VisitPose visitPose(std::uint64_t posed) {
  VisitPose pose;
  if (posed == 0) {
    return pose;
  }
  std::uint64_t counter = 0;
  const auto between = [&](double low, double high) {
    return low + (high - low) * uniformFrom(randomBits(posed + 0x715317U, counter++));
  };
  const double about_x = between(-10.0, 10.0) * kDegree;
  const double about_y = between(-10.0, 10.0) * kDegree;
  const double about_z = between(-10.0, 10.0) * kDegree;
  const Vector3d shift_mm(between(-15.0, 15.0), between(-15.0, 15.0), between(-15.0, 15.0));
  pose.room_from_foot.linear() = (Eigen::AngleAxisd(about_z, Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(about_y, Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(about_x, Vector3d::UnitX()))
                                     .toRotationMatrix();
  pose.room_from_foot.translation() = kHeel_mm + shift_mm - pose.room_from_foot.linear() * kHeel_mm;
  pose.toe_bend_rad = between(-0.15, 0.3);
  pose.start_share = between(0.0, 0.08);
  pose.camera_roll_rad = between(-12.0, 12.0) * kDegree;
  const double brightness = between(0.8, 1.05);
  const double warmth = between(-0.08, 0.08);
  pose.light = {brightness * (1.0 + warmth), brightness, brightness * (1.0 - warmth)};
  return pose;
}

SimulatorOptions weeksLater(SimulatorOptions first, HealingCourse course, int weeks) {
  const double w = weeks;
  SimulatorOptions now = first;
  switch (course) {
    case HealingCourse::Shrinking:  // half the area in 4 weeks
      now.area_factor = std::exp(-0.173 * w);
      now.depth_factor = std::exp(-0.09 * w);
      break;
    case HealingCourse::Deepening:
      now.depth_factor = 1.0 + 0.1 * w;
      break;
    case HealingCourse::Filling:
      now.area_factor = std::exp(-0.03 * w);
      now.depth_factor = std::exp(-0.2 * w);
      break;
    case HealingCourse::Splitting:
      now.area_factor = std::exp(-0.08 * w);
      now.depth_factor = std::exp(-0.09 * w);
      now.split = weeks >= 6;
      break;
  }
  if (weeks > 0) {
    now.posed = mixBits(first.seed * 1000 + static_cast<std::uint64_t>(weeks));
    now.seed = first.seed + static_cast<std::uint64_t>(weeks);
  }
  return now;
}

std::vector<UlcerDesign> ulcersAt(const SimulatorOptions& options) {
  const double bend_rad = visitPose(options.posed).toe_bend_rad;
  std::vector<UlcerDesign> ulcers;
  for (UlcerDesign design : ulcerDesigns(options.foot)) {
    if (design.on_toe) {
      const RigidTransform bend = bentToe(*design.on_toe, bend_rad);
      design.seen_from = bend * design.seen_from;
      design.seen_towards = bend.linear() * design.seen_towards;
    }
    design = later(design, options);
    if (options.split) {
      const auto parts = halves(design);
      ulcers.insert(ulcers.end(), parts.begin(), parts.end());
    } else {
      ulcers.push_back(design);
    }
  }
  return ulcers;
}

}  // namespace tarsus
