#include "reconstruction/capture/device_profile.h"

#include "reconstruction/base/require.h"
#include "reconstruction/capture/device_profile_texts.h"
#include "reconstruction/capture/json_fields.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

using nlohmann::json;

std::vector<std::string> sentences(const json& object, const std::string& key) {
  std::vector<std::string> result;
  const auto found = object.find(key);
  if (found == object.end()) {
    return result;
  }
  bool whole = found->is_array();
  for (std::size_t i = 0; whole && i < found->size(); ++i) {
    whole = (*found)[i].is_string() && !(*found)[i].get<std::string>().empty();
    result.push_back(whole ? (*found)[i].get<std::string>() : std::string());
  }
  if (!whole) {
    throw InvalidField{"\"" + key + "\" must be a list of texts"};
  }
  return result;
}

void readRange(const json& object, DeviceProfile& profile) {
  const auto range = object.find("range_mm");
  const bool whole = range != object.end() && range->is_array() && range->size() == 2 &&
                     (*range)[0].is_number() && (*range)[1].is_number();
  if (whole) {
    profile.near_mm = (*range)[0].get<double>();
    profile.far_mm = (*range)[1].get<double>();
  }
  if (!whole || !(profile.near_mm > 0.0) || !(profile.far_mm > profile.near_mm)) {
    throw InvalidField{"\"range_mm\" must be [near, far] with 0 < near < far"};
  }
}

DeviceProfile parse(const json& object) {
  if (!object.is_object()) {
    throw InvalidField{"a device profile must be an object"};
  }
  DeviceProfile profile;
  const auto name = object.find("name");
  if (name == object.end() || !name->is_string() || name->get<std::string>().empty()) {
    throw InvalidField{"\"name\" must be a text"};
  }
  profile.name = name->get<std::string>();
  profile.models = sentences(object, "models");
  if (profile.models.empty()) {
    throw InvalidField{"\"models\" must name at least one model"};
  }
  readRange(object, profile);
  profile.warm_up_s = numberField(object, "warm_up_s");
  if (profile.warm_up_s < 0.0) {
    throw InvalidField{"\"warm_up_s\" must not be negative"};
  }
  if (object.contains("depth_units_per_m")) {
    profile.depth_units_per_m = numberField(object, "depth_units_per_m");
    if (*profile.depth_units_per_m <= 0.0) {
      throw InvalidField{"\"depth_units_per_m\" must be greater than 0"};
    }
  }
  if (object.contains("depth")) {
    profile.depth = intrinsicsField(object, "depth");
  }
  if (object.contains("depth_correction")) {
    profile.correction = depthCorrectionField(object, "depth_correction");
  }
  profile.traps = sentences(object, "traps");
  return profile;
}

std::string lowered(std::string_view text) {
  std::string result(text);
  std::ranges::transform(
      result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::string metres(double mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f m", mm / 1000.0);
  return text;
}

std::string wholeSeconds(double seconds) { return std::to_string(std::lround(seconds)) + " s"; }

}  // namespace

Expected<DeviceProfile> parseDeviceProfile(std::string_view text, const std::string& file) {
  try {
    return parse(json::parse(text));
  } catch (const InvalidField& invalid) {
    return fail(ErrorCode::CameraFactsInvalid, file + ": " + invalid.what);
  } catch (const json::exception& exception) {
    return fail(ErrorCode::CameraFactsInvalid, file + ": " + exception.what());
  }
}

std::vector<DeviceProfile> deviceProfiles() {
  std::vector<DeviceProfile> profiles;
  for (const DeviceProfileText& entry : deviceProfileTexts()) {
    auto profile = parseDeviceProfile(entry.text, std::string(entry.file));
    TARSUS_REQUIRE(profile.has_value(), "the profiles of resources/devices are whole");
    profiles.push_back(std::move(*profile));
  }
  return profiles;
}

const DeviceProfile* profileOf(std::string_view model, std::span<const DeviceProfile> profiles) {
  const std::string wanted = lowered(model);
  const DeviceProfile* best = nullptr;
  std::size_t longest = 0;
  for (const DeviceProfile& profile : profiles) {
    for (const std::string& text : profile.models) {
      if (text.size() > longest && wanted.find(lowered(text)) != std::string::npos) {
        best = &profile;
        longest = text.size();
      }
    }
  }
  return best;
}

Warnings doubtsAboutDepth(std::string_view model,
                          const DeviceProfile* profile,
                          std::optional<double> median_mm,
                          std::optional<double> seconds_since_power_on) {
  Warnings warnings;
  if (profile == nullptr) {
    if (!model.empty()) {
      warnings.push_back({"device_unknown",
                          "There is no profile of the camera \"" + std::string(model) +
                              "\"; its range, warm-up and depth correction are not known. Check "
                              "lengths against an object of known size."});
    }
    return warnings;
  }
  if (median_mm && (*median_mm < profile->near_mm || *median_mm > profile->far_mm)) {
    warnings.push_back({"depth_outside_range",
                        "The scan's median depth is " + metres(*median_mm) + "; " + profile->name +
                            " measures from " + metres(profile->near_mm) + " to " +
                            metres(profile->far_mm) +
                            ". Check the depth unit, or scan again from "
                            "a distance within that range."});
  }
  if (seconds_since_power_on && *seconds_since_power_on < profile->warm_up_s) {
    warnings.push_back({"camera_not_warm",
                        "The scan began " + wholeSeconds(*seconds_since_power_on) +
                            " after the camera was switched on; " + profile->name + " needs " +
                            wholeSeconds(profile->warm_up_s) +
                            " to warm up, and its depth may drift until then."});
  }
  return warnings;
}

}  // namespace tarsus
