#include "app/cli/camera_options.h"

#include "app/cli/checks.h"

#include <CLI/CLI.hpp>

namespace tarsus {

void addCameraOptions(CLI::App& sub, CameraArguments& arguments) {
  sub.add_option("--intrinsics", arguments.intrinsics, "fx,fy,cx,cy in pixels")
      ->delimiter(',')
      ->expected(4)
      ->type_name("FX,FY,CX,CY");
  sub.add_option("--depth-scale", arguments.depth_scale, "Depth units per metre (8000: 0.125 mm)")
      ->check(inRange(1e-6, 1e9));
}

CameraOverrides overridesOf(const CameraArguments& arguments) {
  CameraOverrides overrides;
  if (arguments.intrinsics.size() == 4) {
    const auto& k = arguments.intrinsics;
    overrides.intrinsics = CameraOverrides::Pinhole{k[0], k[1], k[2], k[3]};
  }
  if (arguments.depth_scale > 0.0) {
    overrides.depth_units_per_m = arguments.depth_scale;
  }
  return overrides;
}

}  // namespace tarsus
