#include "reconstruction/base/require.h"
#include "reconstruction/capture/simulator/camera_path.h"
#include "reconstruction/capture/simulator/renderer.h"
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
    return static_cast<int>(scene_->trajectory.size());
  }
  [[nodiscard]] const Warnings& warnings() const override { return warnings_; }

  [[nodiscard]] Expected<std::optional<RgbdFrame>> next() override {
    if (next_ >= static_cast<int>(scene_->trajectory.size())) {
      return std::optional<RgbdFrame>();
    }
    return std::optional<RgbdFrame>(take(next_++));
  }

 private:
  [[nodiscard]] const RigidTransform& pose(int index) const {
    const int last = static_cast<int>(scene_->trajectory.size()) - 1;
    return *scene_->trajectory[static_cast<std::size_t>(std::clamp(index, 0, last))]
                .scan_from_camera;
  }

  [[nodiscard]] RgbdFrame take(int index) const {
    RgbdFrame frame;
    frame.index = index;
    frame.timestamp = scene_->trajectory[static_cast<std::size_t>(index)].timestamp;
    IdealView view = renderer_.render(camera_.depth, pose(index));
    frame.depth = senseDepth(view, camera_.depth, sensor_, index);
    if (options_.layout == CameraLayout::Offset) {
      view = renderer_.render(camera_.color, pose(index) * camera_.color_from_depth.inverse());
    }
    frame.color = senseColor(view.color, sensor_, smearOf(index), index);
    return frame;
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
  int next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> openSimulator(std::shared_ptr<const SimulatedScene> scene,
                                           const SimulatorOptions& options) {
  TARSUS_REQUIRE(scene != nullptr, "a scene to look at");
  return std::make_unique<SimulatedSource>(std::move(scene), options);
}

}  // namespace tarsus
