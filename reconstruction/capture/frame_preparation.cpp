#include "reconstruction/capture/frame_preparation.h"

#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/device_profile.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace tarsus {
namespace {

constexpr double kNearestPlausibleMm = 150.0;
constexpr double kFarthestPlausibleMm = 2000.0;
constexpr double kEnoughDepth = 0.01;  ///< share of pixels that such a frame must have

RgbdCamera withoutDistortion(RgbdCamera camera) {
  camera.depth.distortion = {};
  camera.color.distortion = {};
  return camera;
}

}  // namespace

Expected<DepthFacts> depthFacts(const std::filesystem::path& camera_file,
                                const std::string& model,
                                std::optional<double> median_mm) {
  std::error_code ignored;
  const auto said = std::filesystem::exists(camera_file, ignored) ? readScanFacts(camera_file)
                                                                  : Expected<ScanFacts>();
  if (!said) {
    return tl::unexpected(said.error());
  }
  const std::vector<DeviceProfile> profiles = deviceProfiles();
  const DeviceProfile* profile = profileOf(model, profiles);
  const DepthCorrection usual = profile != nullptr ? profile->correction : DepthCorrection{};
  return DepthFacts{
      .correction = said->depth_correction.value_or(usual),
      .doubts = doubtsAboutDepth(model, profile, median_mm, said->seconds_since_power_on)};
}

Expected<void> apply(const CameraOverrides& overrides, RgbdCamera& camera) {
  if (overrides.depth_units_per_m) {
    camera.depth_units_per_m = *overrides.depth_units_per_m;
  }
  if (overrides.intrinsics) {
    const auto& given = *overrides.intrinsics;
    camera.depth.fx_px = given.fx_px;
    camera.depth.fy_px = given.fy_px;
    camera.depth.cx_px = given.cx_px;
    camera.depth.cy_px = given.cy_px;
    camera.depth.distortion = {};
    camera.color = camera.depth;
    camera.color_from_depth = RigidTransform::Identity();
  }
  const bool usable =
      camera.depth_units_per_m > 0.0 && camera.depth.fx_px > 0.0 && camera.depth.fy_px > 0.0;
  return usable ? Expected<void>()
                : fail(ErrorCode::CameraFactsInvalid,
                       "--intrinsics and --depth-scale must be greater than 0");
}

std::optional<double> medianDepth(const DepthImage& depth) {
  std::vector<float> measured;
  std::ranges::copy_if(
      depth.pixels(), std::back_inserter(measured), [](float z_mm) { return z_mm > 0.0F; });
  if (static_cast<double>(measured.size()) <
      kEnoughDepth * static_cast<double>(depth.pixels().size())) {
    return std::nullopt;
  }
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::ranges::nth_element(measured, middle);
  return *middle;
}

Expected<void> checkMedianDepth(double median_mm, double depth_units_per_m) {
  if (median_mm < kNearestPlausibleMm || median_mm > kFarthestPlausibleMm) {
    return fail(ErrorCode::DepthUnitImplausible,
                "the median depth would be " + std::to_string(median_mm / 1000.0) + " m with " +
                    std::to_string(depth_units_per_m) + " units per metre");
  }
  return {};
}

FramePreparation::FramePreparation(const RgbdCamera& sensor, const DepthCorrection& correction)
    : depth_undistorter_(sensor.depth),
      color_undistorter_(sensor.color),
      camera_(withoutDistortion(sensor)),
      correction_(correction) {}

DepthImage FramePreparation::depth(DepthImage sensor) const {
  return corrected(depth_undistorter_.apply(std::move(sensor)), correction_, camera_.depth);
}

ColorImage FramePreparation::color(ColorImage sensor) const {
  return color_undistorter_.apply(std::move(sensor));
}

}  // namespace tarsus
