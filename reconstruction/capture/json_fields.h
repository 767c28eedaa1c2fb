#pragma once

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/error.h"
#include "reconstruction/capture/depth_correction.h"

#include <nlohmann/json.hpp>

#include <filesystem>
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

/// What `parse` makes of a JSON file; it may throw InvalidField and nlohmann's exceptions.
/// @errors FileMissing, FileUnreadable, CameraFactsInvalid
template <typename Facts>
[[nodiscard]] Expected<Facts> readJsonFile(const std::filesystem::path& path,
                                           Facts (*parse)(const nlohmann::json&)) {
  const auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  try {
    return parse(nlohmann::json::parse(*text));
  } catch (const InvalidField& invalid) {
    return fail(ErrorCode::CameraFactsInvalid, path.string() + ": " + invalid.what);
  } catch (const nlohmann::json::exception& exception) {
    return fail(ErrorCode::CameraFactsInvalid, path.string() + ": " + exception.what());
  }
}

[[nodiscard]] nlohmann::json intrinsicsJson(const Intrinsics& intrinsics);
[[nodiscard]] nlohmann::json cameraJson(const RgbdCamera& camera);
[[nodiscard]] nlohmann::json depthCorrectionJson(const DepthCorrection& correction);

}  // namespace tarsus
