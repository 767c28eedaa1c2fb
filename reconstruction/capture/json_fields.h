#pragma once

#include "reconstruction/capture/depth_correction.h"

#include <nlohmann/json.hpp>

#include <string>

namespace tarsus {

/// Thrown by the functions below when a field is not what it must be; readCamera and its like turn
/// it into an Error.
struct InvalidField {
  std::string what;  ///< which field, and what it must be
};

[[nodiscard]] double numberField(const nlohmann::json& object, const std::string& key);

/// Size and pinhole, with "distortion" where there is one.
[[nodiscard]] Intrinsics intrinsicsField(const nlohmann::json& object, const std::string& key);

/// The object of resources/devices/README.md. A scale far from 1 is refused: it is a depth unit in
/// the wrong place.
[[nodiscard]] DepthCorrection depthCorrectionField(const nlohmann::json& object,
                                                   const std::string& key);

/// The fields of camera.json (design.md section 3); others are ignored.
[[nodiscard]] RgbdCamera cameraFields(const nlohmann::json& object);

[[nodiscard]] nlohmann::json intrinsicsJson(const Intrinsics& intrinsics);
[[nodiscard]] nlohmann::json cameraJson(const RgbdCamera& camera);
[[nodiscard]] nlohmann::json depthCorrectionJson(const DepthCorrection& correction);

}  // namespace tarsus
