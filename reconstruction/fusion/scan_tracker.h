#pragma once

#include "reconstruction/fusion/fusion.h"

#include <memory>

namespace tarsus {

/// The first stage frame by frame, for a recorded and a live scan alike: push a frame, get its
/// pose; the frame is fused when it was tracked.
class ScanTracker {
 public:
  ScanTracker(const RgbdCamera& camera, const TrackingOptions& options);
  ScanTracker(ScanTracker&&) noexcept;
  ScanTracker& operator=(ScanTracker&&) noexcept;
  ScanTracker(const ScanTracker&) = delete;
  ScanTracker& operator=(const ScanTracker&) = delete;
  ~ScanTracker();

  /// @return where the camera was; without a pose where tracking was lost. The first frame with
  ///         enough depth gets exactly the identity.
  [[nodiscard]] FramePose push(const RgbdFrame& frame);
  /// The field so far, in the scan frame, at the fine voxel size.
  [[nodiscard]] const TsdfVolume& model() const;
  [[nodiscard]] int relocalisations() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
