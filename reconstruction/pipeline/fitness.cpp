#include "reconstruction/pipeline/fitness.h"

#include <cstdio>

namespace tarsus {
namespace {

constexpr double kMaxLostFraction = 0.2;
constexpr double kMaxResidual_mm = 2.0;
constexpr double kMaxUnseenFraction = 0.3;
constexpr double kMaxLoopResidual_mm = 1.0;
constexpr double kMaxContradictingFraction = 0.02;
constexpr double kMaxThroughShare = 0.015;

std::string sentence(const char* format, double a, double b) {
  char text[256];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

Warnings refusalReasons(const Reconstruction& reconstruction) {
  Warnings reasons;
  const double lost = static_cast<double>(reconstruction.framesLost()) /
                      static_cast<double>(std::max(1, reconstruction.frames_total));
  if (lost > kMaxLostFraction) {
    reasons.push_back({"frames_lost",
                       sentence("%.0f %% of the frames could not be placed (at most %.0f %%); scan "
                                "again, moving slowly.",
                                100.0 * lost,
                                100.0 * kMaxLostFraction)});
  }
  if (reconstruction.tracking_rmse_mm.value_or(0.0) > kMaxResidual_mm) {
    reasons.push_back({"residual_high",
                       sentence("The frames disagree by %.1f mm (at most %.1f mm); scan again with "
                                "the foot kept still.",
                                *reconstruction.tracking_rmse_mm,
                                kMaxResidual_mm)});
  }
  if (reconstruction.loop_residual_mm.value_or(0.0) > kMaxLoopResidual_mm) {
    reasons.push_back({"loop_open",
                       sentence("Where the camera came back, the surface is %.1f mm off (at most "
                                "%.1f mm); scan again, moving slowly, with the foot kept still.",
                                *reconstruction.loop_residual_mm,
                                kMaxLoopResidual_mm)});
  }
  if (!reconstruction.loop_residual_mm && reconstruction.loops_unmeasured > 0) {
    reasons.push_back({"loop_unmeasured",
                       "Where the camera came back, the surface does not fit what it saw before; "
                       "scan again, moving slowly, with the foot kept still."});
  }
  const double contradicting = static_cast<double>(reconstruction.frames_contradicting) /
                               static_cast<double>(std::max(1, reconstruction.frames_total));
  if (contradicting > kMaxContradictingFraction ||
      reconstruction.median_through_share > kMaxThroughShare) {
    reasons.push_back(
        {"frames_contradict",
         sentence("Frames contradict each other about where the surface is (%.0f %% of "
                  "the frames; in the middle frame %.1f %% of the surface); scan again, "
                  "moving slowly, with the foot kept still.",
                  100.0 * contradicting,
                  100.0 * reconstruction.median_through_share)});
  }
  if (reconstruction.unseen_fraction > kMaxUnseenFraction) {
    reasons.push_back({"unseen",
                       sentence("%.0f %% of the surface was seen by no sharp picture (at most %.0f "
                                "%%); scan again from more sides.",
                                100.0 * reconstruction.unseen_fraction,
                                100.0 * kMaxUnseenFraction)});
  }
  return reasons;
}

}  // namespace tarsus
