#include "measurement/comparison/comparison.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace tarsus {
namespace {

using nlohmann::json;

json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

json matrixOf(const RigidTransform& transform) {
  json rows = json::array();
  for (int r = 0; r < 4; ++r) {
    json row = json::array();
    for (int c = 0; c < 4; ++c) {
      row.push_back(transform.matrix()(r, c));
    }
    rows.push_back(row);
  }
  return rows;
}

json toJson(const Change& change) {
  return {{"value", number(change.value)},
          {"percent", number(change.percent)},
          {"sdc", number(change.sdc)},
          {"detectable", change.detectable ? json(*change.detectable) : json(nullptr)}};
}

json toJson(const std::vector<SectorChange>& sectors) {
  json list = json::array();
  for (const SectorChange& sector : sectors) {
    list.push_back({{"clock", sector.clock},
                    {"edge_mm", number(sector.edge_mm)},
                    {"gain_mm3", sector.gain_mm3},
                    {"loss_mm3", sector.loss_mm3}});
  }
  return list;
}

}  // namespace

json toJson(const VisitComparison& comparison) {
  const auto change = [&](const char* name) -> const Change* {
    const auto it = comparison.changes.find(name);
    return it != comparison.changes.end() ? &it->second : nullptr;
  };
  const auto percent = [&](const char* name) {
    const Change* found = change(name);
    return found != nullptr ? number(found->percent) : json(nullptr);
  };
  json changes = json::object();
  for (const auto& [name, one] : comparison.changes) {
    changes[name] = toJson(one);
  }
  const Registration& r = comparison.registration;
  const Change* depth = change("max_depth_mm");
  return {{"rms_residual_mm", comparison.aligned ? json(r.rms_residual_mm) : json(nullptr)},
          {"inlier_fraction", comparison.aligned ? json(r.inlier_fraction) : json(nullptr)},
          {"accepted", r.accepted},
          {"refusal", r.accepted ? json(nullptr) : json(r.refusal)},
          {"slide_mm", comparison.aligned ? number(r.slide_mm) : json(nullptr)},
          {"b_from_a", r.accepted ? matrixOf(r.b_from_a) : json(nullptr)},
          {"area_change_percent", percent("opening_area_mm2")},
          {"volume_change_percent", percent("volume_mm3")},
          {"max_depth_change_mm", depth != nullptr ? number(depth->value) : json(nullptr)},
          {"changes", changes},
          {"not_measurable", comparison.not_comparable},
          {"par_percent", number(comparison.par_percent)},
          {"gilman_mm_per_week", number(comparison.gilman_mm_per_week)},
          {"rate_per_week", number(comparison.rate_per_week)},
          {"limit_of_detection_mm",
           comparison.map ? number(comparison.map->limit_of_detection_mm) : json(nullptr)},
          {"sectors", comparison.sectors ? toJson(*comparison.sectors) : json(nullptr)},
          {"why_no_sectors",
           comparison.why_no_sectors.empty() ? json(nullptr) : json(comparison.why_no_sectors)},
          {"note", "Healing rates describe what was measured; they are not a prediction."}};
}

}  // namespace tarsus
