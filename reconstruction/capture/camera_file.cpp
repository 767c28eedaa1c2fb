#include "reconstruction/capture/camera_file.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/json_fields.h"

#include <string>

namespace tarsus {
namespace {

using nlohmann::json;

ScanFacts parseScanFacts(const json& object) {
  if (!object.is_object()) {
    throw InvalidField{"camera.json must hold an object"};
  }
  ScanFacts facts;
  if (object.contains("depth_correction")) {
    facts.depth_correction = depthCorrectionField(object, "depth_correction");
  }
  if (object.contains("seconds_since_power_on")) {
    facts.seconds_since_power_on = numberField(object, "seconds_since_power_on");
  }
  return facts;
}

}  // namespace

Expected<RgbdCamera> readCamera(const std::filesystem::path& path) {
  return readJsonFile(path, cameraFields);
}

Expected<ScanFacts> readScanFacts(const std::filesystem::path& path) {
  return readJsonFile(path, parseScanFacts);
}

Expected<void> writeCamera(const std::filesystem::path& path,
                           const RgbdCamera& camera,
                           const ScanFacts& facts) {
  json object = cameraJson(camera);
  if (facts.depth_correction) {
    object["depth_correction"] = depthCorrectionJson(*facts.depth_correction);
  }
  if (facts.seconds_since_power_on) {
    object["seconds_since_power_on"] = *facts.seconds_since_power_on;
  }
  return writeTextAtomically(path, object.dump(1) + "\n");
}

}  // namespace tarsus
