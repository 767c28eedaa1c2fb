#include "reconstruction/capture/camera_file.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/json_fields.h"

#include <cmath>
#include <string>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr double kMmPerM = 1000.0;
RigidTransform parseTransform(const json& rows) {
  Eigen::Matrix4d matrix;
  bool whole = rows.is_array() && rows.size() == 4;
  for (std::size_t i = 0; whole && i < 4; ++i) {
    whole = rows[i].is_array() && rows[i].size() == 4;
    for (std::size_t k = 0; whole && k < 4; ++k) {
      whole = rows[i][k].is_number();
      matrix(static_cast<int>(i), static_cast<int>(k)) = whole ? rows[i][k].get<double>() : 0.0;
    }
  }
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const bool rigid = whole && matrix.allFinite() &&
                     (rotation * rotation.transpose()).isIdentity(1e-3) &&
                     rotation.determinant() > 0.0;
  if (!rigid) {
    throw InvalidField{"\"color_from_depth\" must be a rigid 4x4 matrix, row by row, in metres"};
  }
  RigidTransform result = RigidTransform::Identity();
  result.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  result.translation() = matrix.topRightCorner<3, 1>() * kMmPerM;
  return result;
}

RgbdCamera parseCamera(const json& object) {
  if (!object.is_object()) {
    throw InvalidField{"camera.json must hold an object"};
  }
  RgbdCamera camera;
  camera.depth = intrinsicsField(object, "depth");
  camera.color = intrinsicsField(object, "color");
  camera.depth_units_per_m = numberField(object, "depth_scale");
  if (camera.depth_units_per_m <= 0.0) {
    throw InvalidField{"\"depth_scale\" (units per metre) must be greater than 0"};
  }
  if (object.contains("fps")) {
    camera.frames_per_s = numberField(object, "fps");
    if (camera.frames_per_s <= 0.0) {
      throw InvalidField{"\"fps\" must be greater than 0"};
    }
  }
  if (object.contains("color_from_depth")) {
    camera.color_from_depth = parseTransform(object.at("color_from_depth"));
  }
  const auto text = [&](const char* key) {
    return object.contains(key) && object.at(key).is_string() ? object.at(key).get<std::string>()
                                                              : std::string();
  };
  camera.model = text("model");
  camera.serial = text("serial");
  return camera;
}

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

template <typename Facts>
Expected<Facts> readJson(const std::filesystem::path& path, Facts (*parse)(const json&)) {
  auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  try {
    return parse(json::parse(*text));
  } catch (const InvalidField& invalid) {
    return fail(ErrorCode::CameraFactsInvalid, path.string() + ": " + invalid.what);
  } catch (const json::exception& exception) {
    return fail(ErrorCode::CameraFactsInvalid, path.string() + ": " + exception.what());
  }
}

json toJson(const Intrinsics& intrinsics) {
  json object = {{"width", intrinsics.width},
                 {"height", intrinsics.height},
                 {"fx", intrinsics.fx_px},
                 {"fy", intrinsics.fy_px},
                 {"cx", intrinsics.cx_px},
                 {"cy", intrinsics.cy_px}};
  if (intrinsics.distortion != std::array<double, 5>{}) {
    object["distortion"] = intrinsics.distortion;
  }
  return object;
}

json toJson(const DepthCorrection& correction) {
  return {{"scale", correction.scale},
          {"polynomial",
           {{"c0", correction.polynomial[0]},
            {"c1", correction.polynomial[1]},
            {"c2", correction.polynomial[2]}}}};
}

}  // namespace

Expected<RgbdCamera> readCamera(const std::filesystem::path& path) {
  return readJson(path, parseCamera);
}

Expected<ScanFacts> readScanFacts(const std::filesystem::path& path) {
  return readJson(path, parseScanFacts);
}

Expected<void> writeCamera(const std::filesystem::path& path,
                           const RgbdCamera& camera,
                           const ScanFacts& facts) {
  json transform = json::array();
  for (int i = 0; i < 4; ++i) {
    json row = json::array();
    for (int k = 0; k < 4; ++k) {
      const double scale = i < 3 && k == 3 ? 1.0 / kMmPerM : 1.0;
      row.push_back(camera.color_from_depth.matrix()(i, k) * scale);
    }
    transform.push_back(row);
  }
  json object = {{"depth", toJson(camera.depth)},
                 {"color", toJson(camera.color)},
                 {"depth_scale", camera.depth_units_per_m},
                 {"fps", camera.frames_per_s},
                 {"color_from_depth", transform}};
  if (!camera.model.empty()) {
    object["model"] = camera.model;
  }
  if (!camera.serial.empty()) {
    object["serial"] = camera.serial;
  }
  if (facts.depth_correction) {
    object["depth_correction"] = toJson(*facts.depth_correction);
  }
  if (facts.seconds_since_power_on) {
    object["seconds_since_power_on"] = *facts.seconds_since_power_on;
  }
  return writeTextAtomically(path, object.dump(1) + "\n");
}

}  // namespace tarsus
