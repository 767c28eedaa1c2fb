#pragma once

#include "reconstruction/capture/scan_folder.h"

#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): not ours
class App;
}

namespace tarsus {

/// --intrinsics and --depth-scale: camera facts given by hand.
struct CameraArguments {
  std::vector<double> intrinsics;
  double depth_scale = 0.0;
};
void addCameraOptions(CLI::App& sub, CameraArguments& arguments);
[[nodiscard]] CameraOverrides overridesOf(const CameraArguments& arguments);

}  // namespace tarsus
