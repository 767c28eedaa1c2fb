#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/frame.h"

#include <string>

namespace tarsus {

/// What a driver says of a camera.
struct DriverFacts {
  std::string uri;
  std::string model;   ///< vendor and name
  std::string serial;  ///< empty where the driver does not tell
  int depth_width = 0;
  int depth_height = 0;
  int color_width = 0;
  int color_height = 0;
  double frames_per_s = 30.0;
  double depth_field_of_view_rad = 0.0;  ///< horizontal
  double color_field_of_view_rad = 0.0;
  double depth_units_per_m = 1000.0;  ///< by its pixel format
};

struct CameraFacts {
  RgbdCamera camera;
  Warnings warnings;
  bool describes_itself = false;  ///< by its own camera.json: no calibration is looked for
};

/// What is to be believed of it: a simulated camera's own camera.json; else the profile of its
/// model, whose unit stands above the driver's, and nominal intrinsics; else what the driver says.
/// @errors those of readCamera
[[nodiscard]] Expected<CameraFacts> cameraFacts(const DriverFacts& driver);

}  // namespace tarsus
