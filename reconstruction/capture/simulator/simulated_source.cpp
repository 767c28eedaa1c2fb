#include "reconstruction/base/require.h"
#include "reconstruction/capture/simulator/camera_path.h"
#include "reconstruction/capture/simulator/renderer.h"
#include "reconstruction/capture/simulator/scan_fault.h"
#include "reconstruction/capture/simulator/sensor_noise.h"
#include "reconstruction/capture/simulator/simulator.h"

#include <algorithm>
#include <utility>

namespace tarsus {
namespace {

class SimulatedSource final : public FrameSource {
 public:
  SimulatedSource(std::shared_ptr<const SimulatedScene> scene, const SimulatorOptions& options)
      : scene_(std::move(scene)),
        options_(options),
        sensor_{.noise = options.noise, .seed = options.seed},
        camera_(simulatedCamera(options)),
        renderer_(scene_) {}

  [[nodiscard]] const RgbdCamera& camera() const override { return camera_; }
  [[nodiscard]] std::optional<int> frameCount() const override {
    return options_.fault == ScanFault::Dropped ? (poses() + 1) / 2 : poses();
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    while (options_.fault == ScanFault::Dropped && strikes(options_.fault, next_, poses())) {
      ++next_;
    }
    if (next_ >= poses()) {
      return std::optional<RgbdFrame>();
    }
    RgbdFrame frame = take(next_++);
    frame.index = given_++;
    return std::optional<RgbdFrame>(std::move(frame));
  }

 private:
  [[nodiscard]] int poses() const { return static_cast<int>(scene_->trajectory.size()); }
  [[nodiscard]] const RigidTransform& pose(int index) const {
    const int i = std::clamp(index, 0, poses() - 1);
    return *scene_->trajectory[static_cast<std::size_t>(i)].scan_from_camera;
  }
  [[nodiscard]] bool struck(ScanFault fault, int index) const {
    return options_.fault == fault && strikes(fault, index, poses());
  }

  /// @param index  among all frames of the motion
  [[nodiscard]] RgbdFrame take(int index) const {
    RgbdFrame frame;
    frame.timestamp = scene_->trajectory[static_cast<std::size_t>(index)].timestamp;
    if (struck(ScanFault::Black, index)) {
      frame.depth = DepthImage(camera_.depth.width, camera_.depth.height);
      frame.color = ColorImage(camera_.color.width, camera_.color.height);
      return frame;
    }
    const RigidTransform& scan_from_depth = pose(index);
    IdealView view = look(camera_.depth, scan_from_depth, index);
    frame.depth = spoiled(senseDepth(view, camera_.depth, sensor_, index), index);
    if (options_.layout == CameraLayout::Offset) {
      view = look(camera_.color, scan_from_depth * camera_.color_from_depth.inverse(), index);
    }
    frame.color = senseColor(view.color, sensor_, smearOf(index), index);
    if (struck(ScanFault::Mirrored, index)) {
      frame.color = mirrored(std::move(frame.color));
    }
    return frame;
  }

  [[nodiscard]] IdealView look(const Intrinsics& camera,
                               const RigidTransform& scan_from_camera,
                               int index) const {
    return struck(ScanFault::Blocked, index) ? handBefore(camera)
                                             : renderer_.render(camera, scan_from_camera);
  }

  [[nodiscard]] DepthImage spoiled(DepthImage depth, int index) const {
    if (struck(ScanFault::Holes, index)) {
      return withHoles(std::move(depth), options_.seed, index);
    }
    if (struck(ScanFault::Unit, index)) {
      for (float& z_mm : depth.pixels()) {
        z_mm *= kUnitTooLarge;
      }
    }
    return depth;
  }

  /// How far the middle of the foot runs over the image while the shutter is open. The sensor's
  /// own frame time counts, however coarsely the motion is sampled.
  [[nodiscard]] Smear smearOf(int index) const {
    const Eigen::Vector3d middle = 0.5 * (scene_->heel_mm + scene_->toe_mm);
    const auto seen = [&](int i) -> Eigen::Vector2d {
      return camera_.color.project(camera_.color_from_depth * (pose(i).inverse() * middle));
    };
    const int before = std::max(index - 1, 0);
    const int after = std::min(index + 1, static_cast<int>(scene_->trajectory.size()) - 1);
    if (before == after) {
      return {};
    }
    const double frames_between = (after - before) * kMotionSeconds / options_.frames * kSensorFps;
    return {.px = (seen(after) - seen(before)) / frames_between * shutterShare(sensor_, index)};
  }

  std::shared_ptr<const SimulatedScene> scene_;
  SimulatorOptions options_;
  SensorModel sensor_;
  RgbdCamera camera_;
  Renderer renderer_;
  Warnings warnings_;
  int next_ = 0;   ///< among all frames of the motion
  int given_ = 0;  ///< frames handed out
};

}  // namespace

std::unique_ptr<FrameSource> openSimulator(std::shared_ptr<const SimulatedScene> scene,
                                           const SimulatorOptions& options) {
  TARSUS_REQUIRE(scene != nullptr, "a scene to look at");
  return std::make_unique<SimulatedSource>(std::move(scene), options);
}

}  // namespace tarsus
