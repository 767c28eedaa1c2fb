#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/capture/camera_file.h"
#include "reconstruction/capture/depth_correction.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tarsus {

/// What is known of one kind of depth camera; resources/devices/README.md explains each field.
struct DeviceProfile {
  std::string name;
  std::vector<std::string> models;  ///< texts that the camera's model may hold
  std::optional<double> depth_units_per_m;
  double near_mm = 0.0;
  double far_mm = 0.0;
  double warm_up_s = 0.0;
  std::optional<Intrinsics> depth;  ///< of a usual camera, for plausibility only
  DepthCorrection correction;
  std::vector<std::string> traps;  ///< sentences for people
};

/// Reads the text of one profile.
/// @param file  names it in messages
/// @errors CameraFactsInvalid (which field, and what it must be)
[[nodiscard]] Expected<DeviceProfile> parseDeviceProfile(std::string_view text,
                                                         const std::string& file);

/// The profiles of resources/devices, as they were when the program was built.
[[nodiscard]] std::vector<DeviceProfile> deviceProfiles();

/// The profile that names the longest part of the model, upper and lower case alike.
/// @return  null where none does, and where the model is empty
[[nodiscard]] const DeviceProfile* profileOf(std::string_view model,
                                             std::span<const DeviceProfile> profiles);

/// What makes the depth of a scan doubtful: `device_unknown` (a model that no profile names),
/// `depth_outside_range`, `camera_not_warm`.
/// @param profile    of the camera, null where there is none
/// @param median_mm  of a usual frame, before any correction; empty where there is none
[[nodiscard]] Warnings doubtsAboutDepth(std::string_view model,
                                        const DeviceProfile* profile,
                                        std::optional<double> median_mm,
                                        std::optional<double> seconds_since_power_on);

}  // namespace tarsus
