#include "reconstruction/pipeline/scan_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace tarsus {
namespace {

constexpr int kStride = 4;  ///< pixels looked at in each direction

/// Calls `look(u, v)` for pixels of the middle half of the image in each direction.
template <typename Look>
void overMiddle(int width, int height, const Look& look) {
  for (int v = height / 4; v < height - height / 4; v += kStride) {
    for (int u = width / 4; u < width - width / 4; u += kStride) {
      look(u, v);
    }
  }
}

/// Median depth of the middle; nothing where less than a tenth of it is measured.
std::optional<double> distanceOf(const DepthImage& depth) {
  std::vector<float> measured;
  std::size_t all = 0;
  overMiddle(depth.width(), depth.height(), [&](int u, int v) {
    ++all;
    if (depth.at(u, v) > 0.0F) {
      measured.push_back(depth.at(u, v));
    }
  });
  if (measured.empty() || 10 * measured.size() < all) {
    return std::nullopt;
  }
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::ranges::nth_element(measured, middle);
  return static_cast<double>(*middle);
}

struct Light {
  double level = 0.0;  ///< median of the brightest channel
  double bright_share = 0.0;
};

Light lightOf(const ColorImage& color) {
  constexpr int kBright = 250;
  std::array<int, 256> count{};
  int all = 0;
  overMiddle(color.width(), color.height(), [&](int u, int v) {
    const Rgb8& p = color.at(u, v);
    ++count[std::max({p.r, p.g, p.b})];
    ++all;
  });
  Light light;
  int below = 0;
  for (int level = 0; level < 256; ++level) {
    if (2 * below < all) {
      light.level = level;
    }
    below += count[static_cast<std::size_t>(level)];
    light.bright_share += level >= kBright ? count[static_cast<std::size_t>(level)] : 0;
  }
  light.bright_share /= std::max(1, all);
  return light;
}

double seconds(std::chrono::microseconds time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

ScanGuidance ScanGuide::update(const RgbdFrame& frame,
                               const LiveFrame& tracked,
                               double coverage_percent) {
  ScanGuidance now = last_;
  now.distance_mm = distanceOf(frame.depth);
  now.coverage_percent = coverage_percent;
  Light light{.level = now.brightness};
  if (frame.color.width() > 0) {
    light = lightOf(frame.color);
  }
  now.brightness = light.level;
  if (tracked.lost) {
    ++now.frames_lost;
    now.why_lost = now.why_lost ? now.why_lost : whyLost(now);
    pose_.reset();
  } else {
    ++now.frames_kept;
    now.passed_s += time_ ? std::max(0.0, seconds(frame.timestamp - *time_)) : 0.0;
    now.why_lost.reset();
    measureMotion(tracked, now);
  }
  time_ = frame.timestamp;
  now.left_s = std::max(0.0, options_.scan_s - now.passed_s);
  settle(frame.timestamp, urgent(now, frame.color.width() > 0 ? light.bright_share : 0.0));
  now.order = last_.order;
  last_ = now;
  return now;
}

ScanOrder ScanGuide::urgent(const ScanGuidance& now, double bright_share) const {
  if (now.why_lost) {
    return ScanOrder::GoBack;
  }
  if (now.distance_mm && *now.distance_mm < options_.near_mm) {
    return ScanOrder::MoveBack;
  }
  if (!now.distance_mm || *now.distance_mm > options_.far_mm) {
    return ScanOrder::ComeCloser;
  }
  if (now.speed_mm_per_s > options_.fast_mm_per_s || now.turn_deg_per_s > options_.fast_deg_per_s) {
    return ScanOrder::Slower;
  }
  if (now.brightness < options_.dark_level) {
    return ScanOrder::MoreLight;
  }
  if (bright_share > options_.bright_share) {
    return ScanOrder::LessLight;
  }
  return now.coverage_percent >= options_.done_percent ? ScanOrder::Done : ScanOrder::KeepMoving;
}

/// What is seen now tells most: a camera that is too close or far cannot track. Else how it moved
/// before.
LossReason ScanGuide::whyLost(const ScanGuidance& now) const {
  constexpr double kMargin = 0.8;  // outside the band by so much
  if (!now.distance_mm) {
    const bool was_close = last_.distance_mm && *last_.distance_mm < options_.near_mm;
    return was_close ? LossReason::TooClose : LossReason::OutOfSight;
  }
  if (*now.distance_mm < kMargin * options_.near_mm) {
    return LossReason::TooClose;
  }
  if (*now.distance_mm > options_.far_mm / kMargin) {
    return LossReason::TooFar;
  }
  const bool fast =
      now.speed_mm_per_s > options_.fast_mm_per_s || now.turn_deg_per_s > options_.fast_deg_per_s;
  return fast ? LossReason::TooFast : LossReason::OutOfSight;
}

void ScanGuide::measureMotion(const LiveFrame& tracked, ScanGuidance& now) {
  constexpr double kShare = 0.3;  // of the newest in a running mean: a hand trembles
  const FramePose& pose = tracked.pose;
  const double passed_s = pose_ ? seconds(pose.timestamp - pose_->timestamp) : 0.0;
  if (pose_ && passed_s > 0.0) {
    const RigidTransform step = pose_->scan_from_camera->inverse() * *pose.scan_from_camera;
    const double turn_rad = Eigen::AngleAxisd(step.rotation()).angle();
    const auto mix = [&](double& mean, double value) { mean += kShare * (value - mean); };
    mix(now.speed_mm_per_s, step.translation().norm() / passed_s);
    mix(now.turn_deg_per_s, turn_rad * 180.0 / std::numbers::pi / passed_s);
  }
  pose_ = pose;
}

void ScanGuide::settle(std::chrono::microseconds time, ScanOrder wanted) {
  if (wanted != wanted_) {
    wanted_ = wanted;
    wanted_since_ = time;
  }
  const bool at_once = wanted == ScanOrder::GoBack || last_.order == ScanOrder::GoBack;
  if (at_once || time - wanted_since_ >= options_.steady) {
    last_.order = wanted;
  }
}

}  // namespace tarsus
