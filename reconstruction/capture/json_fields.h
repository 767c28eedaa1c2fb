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

}  // namespace tarsus
