#include "reconstruction/capture/rig/rig.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

class SimulatedRig final : public Rig {
 public:
  SimulatedRig(double first, double last, std::function<double()> seconds_now)
      : first_(std::min(first, last)),
        last_(std::max(first, last)),
        seconds_now_(std::move(seconds_now)),
        from_(first),
        to_(first) {}

  Expected<void> move(double place, double speed) override {
    if (!(place >= first_ && place <= last_) || !(speed > 0.0) || !std::isfinite(speed)) {
      return fail(ErrorCode::BadOption,
                  "the rig goes from " + std::to_string(first_) + " to " + std::to_string(last_) +
                      ", at a speed greater than 0");
    }
    from_ = placeNow();
    to_ = place;
    speed_ = speed;
    since_s_ = seconds_now_();
    return {};
  }

  Expected<RigPosition> position() override {
    const double place = placeNow();
    return RigPosition{.place = place, .moving = place != to_};
  }

  Expected<void> stop() override {
    from_ = placeNow();
    to_ = from_;
    return {};
  }

 private:
  [[nodiscard]] double placeNow() const {
    const double way = to_ - from_;
    const double gone = speed_ * std::max(0.0, seconds_now_() - since_s_);
    return gone >= std::abs(way) ? to_ : from_ + std::copysign(gone, way);
  }

  double first_;
  double last_;
  std::function<double()> seconds_now_;
  double from_;
  double to_;
  double speed_ = 1.0;
  double since_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Rig> makeSimulatedRig(double first_place,
                                      double last_place,
                                      std::function<double()> seconds_now) {
  return std::make_unique<SimulatedRig>(first_place, last_place, std::move(seconds_now));
}

}  // namespace tarsus
