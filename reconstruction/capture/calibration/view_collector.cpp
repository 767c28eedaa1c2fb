#include "reconstruction/capture/calibration/view_collector.h"

#include <algorithm>

namespace tarsus {
namespace {

using std::chrono::milliseconds;

/// A hand trembles by some pixels a second; colour and depth may be half a period apart.
constexpr double kStill_px = 1.0;
constexpr milliseconds kStillFor{150};
constexpr milliseconds kForgotten{1500};  ///< looks farther apart say nothing of the time between
/// Our choice: a corner moved by a twentieth of the picture, or the board tilted by some 20
/// degrees.
constexpr double kNew_share = 0.025;

/// The farthest that a corner moved; the board may come turned by 180 degrees.
double motion(const Corners& a, const Corners& b) {
  double as_is = 0.0;
  double turned = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    as_is = std::max(as_is, (a[i] - b[i]).norm());
    turned = std::max(turned, (a[i] - b[b.size() - 1 - i]).norm());
  }
  return std::min(as_is, turned);
}

}  // namespace

BoardLook ViewCollector::add(std::chrono::microseconds time, const ColorImage& color) {
  Look look{.time = time, .corners = findCorners(color, board_)};
  if (look.corners.empty()) {
    before_.reset();
    return BoardLook::NotFound;
  }
  if (before_ &&
      (time - before_->time > kForgotten || motion(before_->corners, look.corners) > kStill_px)) {
    before_.reset();
  }
  if (!before_) {
    before_ = std::move(look);
    return BoardLook::Moving;
  }
  if (time - before_->time < kStillFor) {
    return BoardLook::Moving;
  }
  const bool seen = std::ranges::any_of(taken_, [&](const Corners& corners) {
    return motion(corners, look.corners) < kNew_share * width_px_;
  });
  if (seen) {
    return BoardLook::Seen;
  }
  taken_.push_back(std::move(look.corners));
  return BoardLook::Taken;
}

bool ViewCollector::stillAsTaken(const ColorImage& color) const {
  const Corners corners = findCorners(color, board_);
  return !taken_.empty() && !corners.empty() && motion(taken_.back(), corners) <= kStill_px;
}

void ViewCollector::forgetLast() {
  if (!taken_.empty()) {
    taken_.pop_back();
  }
}

}  // namespace tarsus
