#pragma once

#include "reconstruction/pipeline/live_session.h"
#include "reconstruction/scene/frame.h"

#include <chrono>
#include <optional>

namespace tarsus {

/// What the person who holds the camera should do, one thing at a time, the most urgent first.
enum class ScanOrder {
  GoBack,      ///< tracking is lost: to where the scan was, and wait
  MoveBack,    ///< too close
  ComeCloser,  ///< too far
  Slower,
  MoreLight,
  LessLight,
  KeepMoving,
  Done,  ///< enough was seen; the scan may be ended
};

/// Why tracking was lost, as far as the frames before and after tell.
enum class LossReason { TooClose, TooFar, TooFast, OutOfSight };

struct GuideOptions {
  double near_mm = 300.0;  ///< distance band (clinical.md section 8)
  double far_mm = 500.0;
  /// Above it blur and jumps cost accuracy: a scan of 20 s moves at about 60 mm/s. Ours.
  double fast_mm_per_s = 250.0;
  double fast_deg_per_s = 60.0;
  double dark_level = 45.0;    ///< median of the brightest channel, 0 to 255
  double bright_share = 0.25;  ///< of pixels at 250 and above in the middle
  double done_percent = 90.0;  ///< coverage
  double scan_s = 20.0;        ///< how long a scan is meant to take
  /// An order stands at least so long before another takes its place, so that it can be read;
  /// a lost scan is told at once.
  std::chrono::milliseconds steady{400};
};

/// Everything the scan screen shows beside the picture and the growing surface.
struct ScanGuidance {
  ScanOrder order = ScanOrder::KeepMoving;
  std::optional<LossReason> why_lost;
  std::optional<double> distance_mm;  ///< of what is in the middle; empty: nothing is there
  double speed_mm_per_s = 0.0;
  double turn_deg_per_s = 0.0;
  double brightness = 0.0;  ///< median level in the middle
  double coverage_percent = 0.0;
  double passed_s = 0.0;  ///< of the scan; stands while tracking is lost
  double left_s = 0.0;
  int frames_kept = 0;
  int frames_lost = 0;
};

/// Turns each frame and what tracking made of it into one order. No clock of its own: time is the
/// frames'. Costs about a tenth of a millisecond a frame.
class ScanGuide {
 public:
  explicit ScanGuide(const GuideOptions& options = {}) : options_(options) {}
  /// @param coverage_percent  coverageOf the preview, as last computed
  ScanGuidance update(const RgbdFrame& frame, const LiveFrame& tracked, double coverage_percent);

 private:
  [[nodiscard]] ScanOrder urgent(const ScanGuidance& now, double bright_share) const;
  [[nodiscard]] LossReason whyLost(const ScanGuidance& now) const;
  void measureMotion(const LiveFrame& tracked, ScanGuidance& now);
  void settle(std::chrono::microseconds time, ScanOrder wanted);

  GuideOptions options_;
  ScanGuidance last_;
  std::optional<FramePose> pose_;
  std::optional<std::chrono::microseconds> time_;
  ScanOrder wanted_ = ScanOrder::KeepMoving;
  std::chrono::microseconds wanted_since_{};
};

}  // namespace tarsus
