#pragma once

#include "reconstruction/fusion/preview_mesh.h"
#include "reconstruction/fusion/scan_tracker.h"

#include <memory>

namespace tarsus {

struct LiveOptions {
  /// Rounds of the preview in a second of the scan; 0: none.
  double preview_hz = 5.0;
  /// Blocks meshed after one frame, at most, so that tracking never waits long (3 us a block on one
  /// core, on the average of a foot's band). A round goes on after the next frames.
  int preview_blocks_per_frame = 1000;
  float preview_min_weight = 3.0F;  ///< as in TsdfVolume::extractSurface
};

/// What one frame brought.
struct LiveFrame {
  FramePose pose;          ///< its rmse_mm and inlier_fraction tell how far it can be trusted
  bool lost = false;       ///< no pose: the frame was not fused
  int changed_blocks = 0;  ///< of the model, by this frame
  int meshed_blocks = 0;   ///< of the preview, after this frame
};

/// The preview after one frame. Pieces are shared and never change: a viewer that remembers the
/// pointers it has drawn uploads only the others.
struct LivePreview {
  int frames = 0;  ///< pushed when this was published
  PreviewPieces pieces;
};

/// A scan while it is taken: frames go in, poses and a growing surface come out. It tracks with the
/// very ScanTracker of recorded scans, so the poses are the same to the last bit.
/// One thread pushes; `preview` and `prepare` may be called from any other meanwhile.
class LiveSession {
 public:
  LiveSession(const RgbdCamera& camera,
              const TrackingOptions& tracking,
              const LiveOptions& options = {});
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  LiveSession(LiveSession&&) = delete;
  LiveSession& operator=(LiveSession&&) = delete;

  /// Planes and points of a frame; about half of the work, and apart from the session's state: a
  /// thread that prepares one frame while another pushes the frame before uses both cores.
  [[nodiscard]] PreparedFrame prepare(const RgbdFrame& frame) const;
  LiveFrame push(const PreparedFrame& frame);
  LiveFrame push(const RgbdFrame& frame);
  /// Brings the preview up to date at the end of a scan.
  void finishPreview();
  /// The last published surface; never null.
  [[nodiscard]] std::shared_ptr<const LivePreview> preview() const;
  /// For the pushing thread alone.
  [[nodiscard]] const ScanTracker& tracker() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarsus
