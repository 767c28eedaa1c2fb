#pragma once

#include "reconstruction/capture/calibration/known_camera.h"
#include "reconstruction/capture/openni/openni_camera.h"
#include "reconstruction/capture/scan_recorder.h"
#include "reconstruction/pipeline/coverage.h"
#include "reconstruction/pipeline/scan_guide.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace tarsus {

struct LiveScanOptions {
  GuideOptions guide;
  TrackingOptions tracking;
  LiveOptions live;
  CoverageOptions coverage;
  std::filesystem::path calibration;  ///< as knownCamera takes it
  std::string today;                  ///< ISO 8601, for the calibration's age
  double coverage_every_s = 2.0;      ///< of the scan; it costs 0.1 to 0.5 s of one core
};

/// What a screen shows at one moment; images and surfaces are shared and never change.
struct LiveView {
  CameraState camera = CameraState::Stopped;
  CaptureCounts captured;
  RecorderCounts recorded;
  int not_tracked = 0;           ///< recorded, but too many for tracking to look at them
  std::optional<Error> failure;  ///< why recording ended by itself
  ScanGuidance guidance;
  std::shared_ptr<const RgbdFrame> frame;      ///< the newest, as the sensor gave it; null at first
  std::shared_ptr<const LivePreview> preview;  ///< null before the scan is begun
  std::shared_ptr<const Coverage> coverage;    ///< null at first
  std::shared_ptr<const PreviewSurface> foot;  ///< what the coverage was computed of
  /// The last frame whose place is known, and that place; null, empty: none so far. Its colours may
  /// be laid on the surface, and it is where a lost scan is found again.
  std::shared_ptr<const RgbdFrame> tracked;
  std::optional<RigidTransform> scan_from_camera;
};

/// A camera that is plugged in, by its calibration (see the other knownCamera). A simulated camera
/// describes itself: that it was never calibrated is no warning.
/// @errors those of readCalibration, for a profile that is named
[[nodiscard]] Expected<KnownCamera> knownCamera(const OpenNiCamera& camera,
                                                const std::filesystem::path& calibration,
                                                std::string_view today);

/// A scan as it is taken: camera, recording, tracking, growing surface, coverage and guidance, each
/// in a thread of its own, so that the camera never waits. Before `begin` only camera and distance
/// band are live. Recording comes first: where tracking cannot keep up it passes frames over.
class LiveScan {
 public:
  /// @param uri  as OpenNiCamera::open
  /// @errors those of OpenNiCamera::open and start, and of knownCamera
  [[nodiscard]] static Expected<std::unique_ptr<LiveScan>> open(
      const std::string& uri, const LiveScanOptions& options = {});
  ~LiveScan();
  LiveScan(const LiveScan&) = delete;
  LiveScan& operator=(const LiveScan&) = delete;
  LiveScan(LiveScan&&) = delete;
  LiveScan& operator=(LiveScan&&) = delete;

  [[nodiscard]] const OpenNiCamera& camera() const;
  /// The same by its calibration, and what there is to say of it.
  [[nodiscard]] const KnownCamera& known() const;
  /// Records and tracks from the next frame on; an earlier scan of this object is finished first.
  /// @errors those of ScanRecorder::create
  [[nodiscard]] Expected<void> begin(const std::filesystem::path& folder);
  /// Ends the recording; the camera stays live. What was recorded is a scan folder.
  /// @errors those of ScanRecorder::finish
  [[nodiscard]] Expected<void> end();
  /// From any thread, any time.
  [[nodiscard]] LiveView view() const;

 private:
  struct State;
  explicit LiveScan(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
