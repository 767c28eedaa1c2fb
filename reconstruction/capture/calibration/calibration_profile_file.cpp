#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/calibration/calibration_profile.h"
#include "reconstruction/capture/json_fields.h"

namespace tarsus {
namespace {

using nlohmann::json;

std::string textField(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) {
    throw InvalidField{std::string("\"") + key + "\" must be a text"};
  }
  return found->get<std::string>();
}

std::string optionalText(const json& object, const char* key) {
  return object.contains(key) ? textField(object, key) : std::string();
}

std::optional<double> optionalNumber(const json& object, const char* key) {
  return object.contains(key) ? std::optional(numberField(object, key)) : std::nullopt;
}

const json& objectField(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_object()) {
    throw InvalidField{std::string("\"") + key + "\" must be an object"};
  }
  return *found;
}

int countField(const json& object, const char* key) {
  const double value = numberField(object, key);
  if (value < 0.0 || value > 1e6) {
    throw InvalidField{std::string("\"") + key + "\" must be a number of things"};
  }
  return static_cast<int>(value);
}

std::array<double, 3> threeNumbers(const json& object, const char* key) {
  const auto found = object.find(key);
  bool whole = found != object.end() && found->is_array() && found->size() == 3;
  std::array<double, 3> result{};
  for (std::size_t i = 0; whole && i < 3; ++i) {
    whole = (*found)[i].is_number();
    result[i] = whole ? (*found)[i].get<double>() : 0.0;
  }
  if (!whole) {
    throw InvalidField{std::string("\"") + key + "\" must hold three numbers"};
  }
  return result;
}

json jsonOf(const CameraFit& fit) {
  return {{"views", fit.views},
          {"reprojection_rms_px", fit.rms_px},
          {"coverage", fit.coverage},
          {"near_mm", fit.near_mm},
          {"far_mm", fit.far_mm},
          {"turn_rad", fit.turn_rad},
          {"standard_deviation", intrinsicsJson(fit.deviation)}};
}

CameraFit cameraFitField(const json& parent, const char* key) {
  const json& object = objectField(parent, key);
  return {.views = countField(object, "views"),
          .rms_px = numberField(object, "reprojection_rms_px"),
          .coverage = numberField(object, "coverage"),
          .near_mm = numberField(object, "near_mm"),
          .far_mm = numberField(object, "far_mm"),
          .turn_rad = numberField(object, "turn_rad"),
          .deviation = intrinsicsField(object, "standard_deviation")};
}

json jsonOf(const DepthFit& fit) {
  return {{"views", fit.views},
          {"near_mm", fit.near_mm},
          {"far_mm", fit.far_mm},
          {"terms", fit.terms},
          {"scale_standard_deviation", fit.scale_deviation},
          {"rms_before_mm", fit.rms_before_mm},
          {"rms_after_mm", fit.rms_after_mm}};
}

DepthFit depthFitField(const json& parent, const char* key) {
  const json& object = objectField(parent, key);
  return {.views = countField(object, "views"),
          .near_mm = numberField(object, "near_mm"),
          .far_mm = numberField(object, "far_mm"),
          .terms = textField(object, "terms"),
          .scale_deviation = numberField(object, "scale_standard_deviation"),
          .rms_before_mm = numberField(object, "rms_before_mm"),
          .rms_after_mm = numberField(object, "rms_after_mm")};
}

json jsonOf(const ViewResult& view) {
  json object = {{"name", view.name}};
  const auto text = [&](const char* key, const std::string& value) {
    if (!value.empty()) {
      object[key] = value;
    }
  };
  const auto number = [&](const char* key, const std::optional<double>& value) {
    if (value) {
      object[key] = *value;
    }
  };
  text("color_refused", view.color_refused);
  text("infrared_refused", view.infrared_refused);
  text("depth_refused", view.depth_refused);
  number("color_rms_px", view.color_rms_px);
  number("infrared_rms_px", view.infrared_rms_px);
  number("depth_rms_mm", view.depth_rms_mm);
  number("distance_mm", view.distance_mm);
  number("tilt_rad", view.tilt_rad);
  return object;
}

ViewResult viewOf(const json& object) {
  if (!object.is_object()) {
    throw InvalidField{"\"views\" must hold objects"};
  }
  return {.name = textField(object, "name"),
          .color_refused = optionalText(object, "color_refused"),
          .infrared_refused = optionalText(object, "infrared_refused"),
          .depth_refused = optionalText(object, "depth_refused"),
          .color_rms_px = optionalNumber(object, "color_rms_px"),
          .infrared_rms_px = optionalNumber(object, "infrared_rms_px"),
          .depth_rms_mm = optionalNumber(object, "depth_rms_mm"),
          .distance_mm = optionalNumber(object, "distance_mm"),
          .tilt_rad = optionalNumber(object, "tilt_rad")};
}

const json& listField(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array()) {
    throw InvalidField{std::string("\"") + key + "\" must be a list"};
  }
  return *found;
}

json calibrationJson(const CalibrationProfile& profile) {
  json object = {{"date", profile.date},
                 {"board",
                  {{"columns", profile.board.columns},
                   {"rows", profile.board.rows},
                   {"square_mm", profile.board.square_mm}}},
                 {"color", jsonOf(profile.color)}};
  if (profile.depth) {
    object["depth"] = jsonOf(*profile.depth);
  }
  if (profile.extrinsics) {
    object["color_from_depth"] = {
        {"views", profile.extrinsics->views},
        {"rotation_standard_deviation_rad", profile.extrinsics->rotation_rad},
        {"translation_standard_deviation_mm", profile.extrinsics->translation_mm}};
  }
  if (profile.depth_fit) {
    object["depth_correction"] = jsonOf(*profile.depth_fit);
  }
  object["views"] = json::array();
  for (const ViewResult& view : profile.views) {
    object["views"].push_back(jsonOf(view));
  }
  object["warnings"] = json::array();
  for (const Warning& warning : profile.warnings) {
    object["warnings"].push_back({{"code", warning.code}, {"text", warning.text}});
  }
  return object;
}

void readFits(const json& object, CalibrationProfile& profile) {
  profile.color = cameraFitField(object, "color");
  if (object.contains("depth")) {
    profile.depth = cameraFitField(object, "depth");
  }
  if (object.contains("color_from_depth")) {
    const json& place = objectField(object, "color_from_depth");
    profile.extrinsics =
        ExtrinsicsFit{.views = countField(place, "views"),
                      .rotation_rad = threeNumbers(place, "rotation_standard_deviation_rad"),
                      .translation_mm = threeNumbers(place, "translation_standard_deviation_mm")};
  }
  if (object.contains("depth_correction")) {
    profile.depth_fit = depthFitField(object, "depth_correction");
  }
}

CalibrationProfile parse(const json& whole) {
  if (!whole.is_object()) {
    throw InvalidField{"a calibration must hold an object"};
  }
  CalibrationProfile profile;
  profile.camera = cameraFields(whole);
  if (whole.contains("depth_correction")) {
    profile.depth_correction = depthCorrectionField(whole, "depth_correction");
  }
  const json& object = objectField(whole, "calibration");
  profile.date = textField(object, "date");
  if (!ageInDays(profile.date, profile.date)) {
    throw InvalidField{"\"date\" must be a date such as 2026-03-31"};
  }
  const json& board = objectField(object, "board");
  profile.board = {.columns = countField(board, "columns"),
                   .rows = countField(board, "rows"),
                   .square_mm = numberField(board, "square_mm")};
  readFits(object, profile);
  for (const json& view : listField(object, "views")) {
    profile.views.push_back(viewOf(view));
  }
  for (const json& warning : listField(object, "warnings")) {
    if (!warning.is_object()) {
      throw InvalidField{"\"warnings\" must hold objects"};
    }
    profile.warnings.push_back({textField(warning, "code"), textField(warning, "text")});
  }
  return profile;
}

}  // namespace

Expected<CalibrationProfile> readCalibration(const std::filesystem::path& path) {
  return readJsonFile(path, parse);
}

Expected<void> writeCalibration(const std::filesystem::path& path,
                                const CalibrationProfile& profile) {
  json object = cameraJson(profile.camera);
  if (profile.depth_correction) {
    object["depth_correction"] = depthCorrectionJson(*profile.depth_correction);
  }
  object["calibration"] = calibrationJson(profile);
  return writeTextAtomically(path,
                             object.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace tarsus
