#include "reconstruction/capture/camera_file.h"

#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr double kMmPerM = 1000.0;
constexpr int kMaxImageSide = 16384;

/// Thrown only inside this file; readCamera turns it into an Error.
struct Invalid {
  std::string what;
};

double number(const json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) {
    throw Invalid{"\"" + key + "\" must be a number"};
  }
  const double value = found->get<double>();
  if (!std::isfinite(value)) {
    throw Invalid{"\"" + key + "\" must be finite"};
  }
  return value;
}

Intrinsics parseIntrinsics(const json& camera, const std::string& name) {
  const auto found = camera.find(name);
  if (found == camera.end() || !found->is_object()) {
    throw Invalid{"\"" + name + "\" must be an object with width, height, fx, fy, cx, cy"};
  }
  const double width = number(*found, "width");
  const double height = number(*found, "height");
  Intrinsics result{.fx_px = number(*found, "fx"),
                    .fy_px = number(*found, "fy"),
                    .cx_px = number(*found, "cx"),
                    .cy_px = number(*found, "cy")};
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide ||
      result.fx_px <= 0 || result.fy_px <= 0) {
    throw Invalid{"\"" + name + "\" has a size or focal length that no camera has"};
  }
  result.width = static_cast<int>(width);
  result.height = static_cast<int>(height);
  if (const auto distortion = found->find("distortion"); distortion != found->end()) {
    if (!distortion->is_array() || distortion->size() > result.distortion.size()) {
      throw Invalid{"\"distortion\" must be [k1, k2, p1, p2, k3]"};
    }
    for (std::size_t i = 0; i < distortion->size(); ++i) {
      if (!(*distortion)[i].is_number()) {
        throw Invalid{"\"distortion\" must hold numbers"};
      }
      result.distortion[i] = (*distortion)[i].get<double>();
    }
  }
  return result;
}

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
    throw Invalid{"\"color_from_depth\" must be a rigid 4x4 matrix, row by row, in metres"};
  }
  RigidTransform result = RigidTransform::Identity();
  result.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  result.translation() = matrix.topRightCorner<3, 1>() * kMmPerM;
  return result;
}

RgbdCamera parseCamera(const json& object) {
  if (!object.is_object()) {
    throw Invalid{"camera.json must hold an object"};
  }
  RgbdCamera camera;
  camera.depth = parseIntrinsics(object, "depth");
  camera.color = parseIntrinsics(object, "color");
  camera.depth_units_per_m = number(object, "depth_scale");
  if (camera.depth_units_per_m <= 0.0) {
    throw Invalid{"\"depth_scale\" (units per metre) must be greater than 0"};
  }
  if (object.contains("fps")) {
    camera.frames_per_s = number(object, "fps");
    if (camera.frames_per_s <= 0.0) {
      throw Invalid{"\"fps\" must be greater than 0"};
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

}  // namespace

Expected<RgbdCamera> readCamera(const std::filesystem::path& path) {
  auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  try {
    return parseCamera(json::parse(*text));
  } catch (const Invalid& invalid) {
    return fail(ErrorCode::CameraFactsInvalid, path.string() + ": " + invalid.what);
  } catch (const json::exception& exception) {
    return fail(ErrorCode::CameraFactsInvalid, path.string() + ": " + exception.what());
  }
}

Expected<void> writeCamera(const std::filesystem::path& path, const RgbdCamera& camera) {
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
  return writeTextAtomically(path, object.dump(1) + "\n");
}

}  // namespace tarsus
