#include "measurement/wound/measure.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

std::optional<double> numberOf(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>())
                                                     : std::nullopt;
}

bool areNumbers(const json& list, std::size_t count) {
  return list.is_array() && list.size() == count &&
         std::ranges::all_of(list, [](const json& value) { return value.is_number(); });
}

std::string textOf(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

WoundMeasurement measurementFromJson(const json& object) {
  WoundMeasurement m;
  if (!object.is_object()) {
    return m;
  }
  m.opening_area_mm2 = numberOf(object, "opening_area_mm2");
  m.bed_area_mm2 = numberOf(object, "bed_area_mm2");
  m.projected_area_mm2 = numberOf(object, "projected_area_mm2");
  m.perimeter_mm = numberOf(object, "perimeter_mm");
  m.volume_mm3 = numberOf(object, "volume_mm3");
  m.volume_above_mm3 = numberOf(object, "volume_above_mm3");
  m.mean_depth_mm = numberOf(object, "mean_depth_mm");
  m.max_depth_mm = numberOf(object, "max_depth_mm");
  m.p99_depth_mm = numberOf(object, "p99_depth_mm");
  m.length_mm = numberOf(object, "length_mm");
  m.width_mm = numberOf(object, "width_mm");
  m.length_clock_mm = numberOf(object, "length_clock_mm");
  m.width_clock_mm = numberOf(object, "width_clock_mm");
  m.unseen_bed_fraction = numberOf(object, "unseen_bed_fraction");
  if (const auto at = object.find("max_depth_at_mm"); at != object.end() && areNumbers(*at, 3)) {
    m.max_depth_at_mm =
        Eigen::Vector3d((*at)[0].get<double>(), (*at)[1].get<double>(), (*at)[2].get<double>());
  }
  const json intervals = object.value("intervals", json::object());
  for (const auto& [name, interval] : intervals.items()) {
    if (areNumbers(interval, 2)) {
      m.intervals[name] = {.low = interval[0].get<double>(), .high = interval[1].get<double>()};
    }
  }
  const json reasons = object.value("not_measurable", json::object());
  for (const auto& [name, reason] : reasons.items()) {
    if (reason.is_string()) {
      m.not_measurable[name] = reason.get<std::string>();
    }
  }
  m.method = textOf(object, "method");
  for (const json& warning : object.value("warnings", json::array())) {
    if (warning.is_object()) {
      m.warnings.push_back({textOf(warning, "code"), textOf(warning, "text")});
    }
  }
  return m;
}

json toJson(const WoundMeasurement& m) {
  json intervals = json::object();
  for (const auto& [name, interval] : m.intervals) {
    intervals[name] = {interval.low, interval.high};
  }
  json warnings = json::array();
  for (const Warning& warning : m.warnings) {
    warnings.push_back({{"code", warning.code}, {"text", warning.text}});
  }
  json at = nullptr;
  if (m.max_depth_at_mm) {
    at = {m.max_depth_at_mm->x(), m.max_depth_at_mm->y(), m.max_depth_at_mm->z()};
  }
  return {{"opening_area_mm2", number(m.opening_area_mm2)},
          {"bed_area_mm2", number(m.bed_area_mm2)},
          {"projected_area_mm2", number(m.projected_area_mm2)},
          {"perimeter_mm", number(m.perimeter_mm)},
          {"volume_mm3", number(m.volume_mm3)},
          {"volume_above_mm3", number(m.volume_above_mm3)},
          {"mean_depth_mm", number(m.mean_depth_mm)},
          {"max_depth_mm", number(m.max_depth_mm)},
          {"p99_depth_mm", number(m.p99_depth_mm)},
          {"max_depth_at_mm", at},
          {"length_mm", number(m.length_mm)},
          {"width_mm", number(m.width_mm)},
          {"length_clock_mm", number(m.length_clock_mm)},
          {"width_clock_mm", number(m.width_clock_mm)},
          {"unseen_bed_fraction", number(m.unseen_bed_fraction)},
          {"intervals", intervals},
          {"not_measurable", m.not_measurable},
          {"method", m.method},
          {"warnings", warnings}};
}

}  // namespace tarsus
