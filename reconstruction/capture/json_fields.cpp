#include "reconstruction/capture/json_fields.h"

#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr int kMaxImageSide = 16384;

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
  return correction;
}

}  // namespace tarsus
