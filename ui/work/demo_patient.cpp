#include "ui/work/demo_patient.h"

#include "measurement/records/history.h"

#include <nlohmann/json.hpp>

#include <array>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr std::int64_t kDay_ms = 86'400'000;

struct DemoNumbers {
  int days_ago;
  double area_mm2, area_low, area_high;
  double volume_mm3, volume_low, volume_high;
  double depth_mm, depth_low, depth_high;
  double perimeter_mm;
};

constexpr std::array kVisits{DemoNumbers{42, 786, 730, 844, 2240, 1980, 2520, 4.5, 4.1, 4.9, 107},
                             DemoNumbers{35, 741, 688, 796, 1980, 1750, 2230, 4.3, 3.9, 4.7, 104},
                             DemoNumbers{28, 635, 586, 686, 1580, 1380, 1800, 4.0, 3.6, 4.4, 96},
                             DemoNumbers{14, 428, 388, 469, 1020, 880, 1170, 3.7, 3.3, 4.1, 79},
                             DemoNumbers{0, 363, 327, 400, 810, 700, 930, 3.5, 3.1, 3.9, 73}};

json numbersOf(const DemoNumbers& visit) {
  return {{"opening_area_mm2", visit.area_mm2},
          {"volume_mm3", visit.volume_mm3},
          {"max_depth_mm", visit.depth_mm},
          {"perimeter_mm", visit.perimeter_mm},
          {"intervals",
           {{"opening_area_mm2", {visit.area_low, visit.area_high}},
            {"volume_mm3", {visit.volume_low, visit.volume_high}},
            {"max_depth_mm", {visit.depth_low, visit.depth_high}}}},
          {"method", "invented for the demonstration"},
          {"warnings", json::array()}};
}

json formOf(std::size_t index) {
  json form{{"notes", "Invented for the demonstration."}};
  if (index == 0) {
    form["pulse_dorsalis_pedis"] = "present";
    form["pulse_tibialis_posterior"] = "absent";
    form["monofilament_felt_of_10"] = 3;
  } else if (index == 1) {
    form["hba1c_percent"] = 8.1;
    form["debridement"] = "before_scan";
  } else if (index == 2) {
    form["offloading"] = "Removable walker";
  } else if (index == 3) {
    form["probe_to_bone"] = "negative";
  }
  return form;
}

Expected<void> addDemoVisit(Store& store, const std::string& wound, std::size_t index) {
  const DemoNumbers& numbers = kVisits.at(index);
  const std::int64_t at_ms = store.environment().now_ms() - numbers.days_ago * kDay_ms;
  return addVisit(store, wound, {.taken_at_ms = at_ms, .fields = formOf(index), .files = {}})
      .and_then([&](const Visit& visit) {
        return addMeasurement(store,
                              visit.revision,
                              {.visit_id = visit.id,
                               .numbers = numbersOf(numbers),
                               .outline = json::object(),
                               .options = {{"demonstration", true}},
                               .versions = json::object()});
      })
      .and_then([&](const Measurement& measured) { return findVisit(store, measured.visit_id); })
      .and_then([&](const Visit& visit) {
        return index + 1 == kVisits.size()
                   ? Expected<Visit>(visit)
                   : stepVisit(store, visit.id, visit.revision, VisitStep::Sign);
      })
      .map([](const Visit&) {});
}

}  // namespace

Expected<std::string> addDemoPatient(Store& store) {
  auto change = StoreChange::begin(store, Permission::EditRecords);
  if (!change) {
    return tl::unexpected(change.error());
  }
  const auto patient = addPatient(store,
                                  {.family_name = "Holm",
                                   .given_name = "Margarete",
                                   .birth_date = "1958-03-14",
                                   .identifier = "DEMO-1"});
  if (!patient) {
    return tl::unexpected(patient.error());
  }
  const auto foot = addFoot(store, patient->id, {.side = FootSide::Right, .missing_toes = {}});
  if (!foot) {
    return tl::unexpected(foot.error());
  }
  const auto wound = addWound(store,
                              foot->id,
                              {.place = "mth_2",
                               .aspect = "plantar",
                               .onset = {},
                               .aetiology = "neuropathic",
                               .parents = {},
                               .healed_on = {}});
  if (!wound) {
    return tl::unexpected(wound.error());
  }
  for (std::size_t i = 0; i < kVisits.size(); ++i) {
    if (auto added = addDemoVisit(store, wound->id, i); !added) {
      return tl::unexpected(added.error());
    }
  }
  const auto done = change->commit();
  return done ? Expected<std::string>(patient->id) : tl::unexpected(done.error());
}

}  // namespace tarsus
