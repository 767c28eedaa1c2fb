#include "reconstruction/capture/json_fields.h"

#include <cmath>
#include <utility>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr int kMaxImageSide = 16384;
constexpr double kMmPerM = 1000.0;

DepthCorrection::Quadratic quadratic(const json& polynomial, const std::string& key) {
  DepthCorrection::Quadratic coefficients{};
  const auto found = polynomial.find(key);
  if (found == polynomial.end()) {
    return coefficients;
  }
  bool whole = found->is_array() && found->size() == coefficients.size();
  for (std::size_t i = 0; whole && i < coefficients.size(); ++i) {
    whole = (*found)[i].is_number() && std::isfinite((*found)[i].get<double>());
    coefficients[i] = whole ? (*found)[i].get<double>() : 0.0;
  }
  if (!whole) {
    throw InvalidField{"\"" + key + "\" of the depth polynomial must hold six numbers, for 1, x, " +
                       "y, x^2, x y, y^2"};
  }
  return coefficients;
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
    throw InvalidField{"\"color_from_depth\" must be a rigid 4x4 matrix, row by row, in metres"};
  }
  RigidTransform result = RigidTransform::Identity();
  result.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  result.translation() = matrix.topRightCorner<3, 1>() * kMmPerM;
  return result;
}

}  // namespace

double numberField(const json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) {
    throw InvalidField{"\"" + key + "\" must be a number"};
  }
  const double value = found->get<double>();
  if (!std::isfinite(value)) {
    throw InvalidField{"\"" + key + "\" must be finite"};
  }
  return value;
}

namespace {

/// Generous bounds: what lies outside is a slip of the pen, and would make wrong millimetres.
bool isPlausible(const Intrinsics& lens) {
  const auto within = [](double value, double low, double high) {
    return value >= low && value <= high;
  };
  const double x = std::max(lens.cx_px, lens.width - lens.cx_px) / lens.fx_px;
  const double y = std::max(lens.cy_px, lens.height - lens.cy_px) / lens.fy_px;
  const double r2 = x * x + y * y;  // at the farthest corner
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return within(lens.fx_px, 0.2 * lens.width, 10.0 * lens.width) &&
         within(lens.fy_px / lens.fx_px, 0.5, 2.0) &&
         within(lens.cx_px, -0.5 * lens.width, 1.5 * lens.width) &&
         within(lens.cy_px, -0.5 * lens.height, 1.5 * lens.height) && within(radial, 0.5, 2.0) &&
         within(p1, -0.2, 0.2) && within(p2, -0.2, 0.2);
}

/// No depth camera is off by more than a fifth anywhere in a scan.
bool isPlausible(const DepthCorrection& correction) {
  for (const double z_m : {0.3, 0.6}) {
    for (const double x : {-0.6, 0.0, 0.6}) {
      for (const double y : {-0.5, 0.0, 0.5}) {
        const auto c = [&](const DepthCorrection::Quadratic& a) {
          return a[0] + a[1] * x + a[2] * y + a[3] * x * x + a[4] * x * y + a[5] * y * y;
        };
        const double shift_mm = c(correction.polynomial[0]) + z_m * c(correction.polynomial[1]) +
                                z_m * z_m * c(correction.polynomial[2]);
        const double ratio = correction.scale * (1000.0 * z_m + shift_mm) / (1000.0 * z_m);
        if (!(ratio > 0.8 && ratio < 1.25)) {
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace

Intrinsics intrinsicsField(const json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_object()) {
    throw InvalidField{"\"" + key + "\" must be an object with width, height, fx, fy, cx, cy"};
  }
  const double width = numberField(*found, "width");
  const double height = numberField(*found, "height");
  Intrinsics result{.fx_px = numberField(*found, "fx"),
                    .fy_px = numberField(*found, "fy"),
                    .cx_px = numberField(*found, "cx"),
                    .cy_px = numberField(*found, "cy")};
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide ||
      result.fx_px <= 0 || result.fy_px <= 0) {
    throw InvalidField{"\"" + key + "\" has a size or focal length that no camera has"};
  }
  result.width = static_cast<int>(width);
  result.height = static_cast<int>(height);
  if (const auto distortion = found->find("distortion"); distortion != found->end()) {
    if (!distortion->is_array() || distortion->size() > result.distortion.size()) {
      throw InvalidField{"\"distortion\" must be [k1, k2, p1, p2, k3]"};
    }
    for (std::size_t i = 0; i < distortion->size(); ++i) {
      if (!(*distortion)[i].is_number()) {
        throw InvalidField{"\"distortion\" must hold numbers"};
      }
      result.distortion[i] = (*distortion)[i].get<double>();
    }
  }
  return result;
}

DepthCorrection depthCorrectionField(const json& object, const std::string& key) {
  constexpr double kLeastScale = 0.5;
  constexpr double kGreatestScale = 2.0;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_object()) {
    throw InvalidField{"\"" + key + "\" must be an object with \"scale\" and \"polynomial\""};
  }
  DepthCorrection correction;
  if (found->contains("scale")) {
    correction.scale = numberField(*found, "scale");
    if (correction.scale < kLeastScale || correction.scale > kGreatestScale) {
      throw InvalidField{
          "\"scale\" of the depth correction must lie between 0.5 and 2; the depth " +
          std::string("unit belongs into \"depth_scale\" of camera.json")};
    }
  }
  if (const auto polynomial = found->find("polynomial"); polynomial != found->end()) {
    if (!polynomial->is_object()) {
      throw InvalidField{"\"polynomial\" must be an object with c0, c1, c2"};
    }
    correction.polynomial = {
        quadratic(*polynomial, "c0"), quadratic(*polynomial, "c1"), quadratic(*polynomial, "c2")};
  }
  if (!isPlausible(correction)) {
    throw InvalidField{"\"" + key + "\" changes depths by more than a fifth, as no camera needs"};
  }
  return correction;
}

RgbdCamera cameraFields(const json& object) {
  if (!object.is_object()) {
    throw InvalidField{"camera.json must hold an object"};
  }
  RgbdCamera camera;
  camera.depth = intrinsicsField(object, "depth");
  camera.color = intrinsicsField(object, "color");
  for (const auto& [lens, key] : {std::pair(&camera.depth, "depth"), {&camera.color, "color"}}) {
    if (!isPlausible(*lens)) {
      throw InvalidField{"\"" + std::string(key) + "\" describes a lens that no camera has"};
    }
  }
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
  if (camera.color_from_depth.translation().norm() > 500.0) {
    throw InvalidField{
        "\"color_from_depth\" puts the cameras more than half a metre apart; its "
        "translation is in metres"};
  }
  return camera;
}

json intrinsicsJson(const Intrinsics& intrinsics) {
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

json cameraJson(const RgbdCamera& camera) {
  json transform = json::array();
  for (int i = 0; i < 4; ++i) {
    json row = json::array();
    for (int k = 0; k < 4; ++k) {
      const double scale = i < 3 && k == 3 ? 1.0 / kMmPerM : 1.0;
      row.push_back(camera.color_from_depth.matrix()(i, k) * scale);
    }
    transform.push_back(row);
  }
  json object = {{"depth", intrinsicsJson(camera.depth)},
                 {"color", intrinsicsJson(camera.color)},
                 {"depth_scale", camera.depth_units_per_m},
                 {"fps", camera.frames_per_s},
                 {"color_from_depth", transform}};
  if (!camera.model.empty()) {
    object["model"] = camera.model;
  }
  if (!camera.serial.empty()) {
    object["serial"] = camera.serial;
  }
  return object;
}

json depthCorrectionJson(const DepthCorrection& correction) {
  return {{"scale", correction.scale},
          {"polynomial",
           {{"c0", correction.polynomial[0]},
            {"c1", correction.polynomial[1]},
            {"c2", correction.polynomial[2]}}}};
}

}  // namespace tarsus
