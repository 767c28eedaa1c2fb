#include "reconstruction/capture/openni/camera_facts.h"

#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/device_profile.h"
#include "reconstruction/capture/openni/simulated_camera/address.h"

#include <cmath>

namespace tarsus {
namespace {

Intrinsics byFieldOfView(int width, int height, double field_of_view_rad) {
  Intrinsics lens{.width = width, .height = height};
  lens.cx_px = 0.5 * (width - 1);
  lens.cy_px = 0.5 * (height - 1);
  lens.fx_px = 0.5 * width / std::tan(0.5 * field_of_view_rad);
  lens.fy_px = lens.fx_px;  // square pixels; drivers round the vertical angle
  return lens;
}

/// The same lens before a sensor read out at another size.
Intrinsics scaledTo(Intrinsics lens, int width, int height) {
  const double sx = static_cast<double>(width) / lens.width;
  const double sy = static_cast<double>(height) / lens.height;
  lens.fx_px *= sx;
  lens.fy_px *= sy;
  lens.cx_px = (lens.cx_px + 0.5) * sx - 0.5;
  lens.cy_px = (lens.cy_px + 0.5) * sy - 0.5;
  lens.width = width;
  lens.height = height;
  return lens;
}

}  // namespace

Expected<CameraFacts> cameraFacts(const DriverFacts& driver) {
  if (const auto address = parseSimulatedAddress(driver.uri)) {
    auto camera = readCamera(address->scan / "camera.json");
    if (!camera) {
      return tl::unexpected(camera.error());
    }
    return CameraFacts{.camera = std::move(*camera), .warnings = {}, .describes_itself = true};
  }
  CameraFacts facts;
  RgbdCamera& camera = facts.camera;
  camera.model = driver.model;
  camera.serial = driver.serial;
  camera.frames_per_s = driver.frames_per_s;
  camera.depth_units_per_m = driver.depth_units_per_m;
  camera.depth =
      byFieldOfView(driver.depth_width, driver.depth_height, driver.depth_field_of_view_rad);
  camera.color =
      byFieldOfView(driver.color_width, driver.color_height, driver.color_field_of_view_rad);
  const auto profiles = deviceProfiles();
  const DeviceProfile* profile = profileOf(driver.model, profiles);
  if (profile != nullptr && profile->depth_units_per_m) {
    camera.depth_units_per_m = *profile->depth_units_per_m;
  } else {
    facts.warnings.push_back(
        {"depth_unit_assumed",
         "The depth unit is taken from the driver, which may be wrong; check the camera with a "
         "phantom of known size."});
  }
  if (profile != nullptr && profile->depth) {
    camera.depth = scaledTo(*profile->depth, driver.depth_width, driver.depth_height);
  }
  return facts;
}

}  // namespace tarsus
