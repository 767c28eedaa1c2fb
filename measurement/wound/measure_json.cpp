#include "measurement/wound/measure.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

}  // namespace

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
