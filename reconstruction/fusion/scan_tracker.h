#pragma once

#include "reconstruction/fusion/depth_planes.h"
#include "reconstruction/fusion/fusion.h"

#include <memory>

namespace tarsus {

/// A frame made ready for tracking; may be made on another thread than the one that tracks.
struct PreparedFrame {
  PreparedFrame(const RgbdCamera& camera, const TrackingOptions& options, const RgbdFrame& frame);

  int index;
  std::chrono::microseconds timestamp;
  DepthPlanes planes;
  FramePoints few, some, many;  ///< at three densities
};

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
  [[nodiscard]] FramePose push(const PreparedFrame& frame);
  [[nodiscard]] FramePose push(const RgbdFrame& frame);
  /// Fuses a frame whose pose is known.
  FramePose place(const PreparedFrame& frame, const RigidTransform& scan_from_camera);
  /// The field so far, in the scan frame, at the fine voxel size.
  [[nodiscard]] const TsdfVolume& model() const;
  /// The same, handed over; the tracker is of no use afterwards.
  [[nodiscard]] TsdfVolume takeModel();
  [[nodiscard]] int relocalisations() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
