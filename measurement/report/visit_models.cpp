#include "measurement/report/visit_models.h"

#include "measurement/comparison/comparison.h"
#include "measurement/records/record_json.h"
#include "measurement/records/visit_measurement.h"
#include "measurement/report/change_picture.h"
#include "measurement/report/section_profile.h"
#include "measurement/wound/wound_view.h"
#include "reconstruction/base/parallel.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kDay_ms = 86'400'000.0;

std::vector<Eigen::Vector2d> outlineOf(const json& sketch) {
  std::vector<Eigen::Vector2d> outline;
  const json points = sketch.is_object() ? sketch.value("outline_mm", json::array()) : json();
  for (const json& point : points) {
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number()) {
      return {};
    }
    outline.emplace_back(point[0].get<double>(), point[1].get<double>());
  }
  return outline;
}

/// By probe; 0 where there is none, nothing where nobody wrote it down.
std::optional<double> deepestOf(const json& fields, const char* name) {
  const auto ranges = fields.find(name);
  if (ranges == fields.end() || !ranges->is_array()) {
    return std::nullopt;
  }
  double deepest = 0.0;
  for (const json& range : *ranges) {
    deepest = std::max(deepest, range.value("depth_mm", 0.0));
  }
  return deepest;
}

void sketchFromModel(ReportedVisit& visit) {
  const MeasuredModel& model = *visit.model;
  const WoundView view = viewOf(model.foot.mesh, model.wound, model.landmarks);
  visit.outline_mm = outlineInView(model.wound, view);
}

/// Decrypts one after the other, as the store belongs to one thread; reads and measures at once.
Expected<void> openTogether(Store& store,
                            std::span<ReportedVisit* const> visits,
                            const fs::path& folder) {
  std::vector<WoundFiles> files;
  for (const ReportedVisit* visit : visits) {
    auto kept = visitFiles(store, visit->visit, folder / visit->visit.id);
    if (!kept) {
      return tl::unexpected(kept.error());
    }
    files.push_back(std::move(*kept));
  }
  std::vector<Expected<void>> done(visits.size());
  parallelFor(static_cast<int>(visits.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    // The geometry alone: the numbers and their intervals are those that the visit keeps.
    auto model = measureFiles(files[k], {.intervals = false});
    if (!model) {
      done[k] = tl::unexpected(model.error());
      return;
    }
    visits[k]->model = std::move(*model);
    if (visits[k]->outline_mm.size() < 3) {
      sketchFromModel(*visits[k]);
    }
  });
  const auto failed = std::ranges::find_if(done, [](const auto& each) { return !each; });
  return failed == done.end() ? Expected<void>() : *failed;
}

double daysBetween(const ReportedVisit& a, const ReportedVisit& b) {
  return static_cast<double>(b.visit.content.taken_at_ms - a.visit.content.taken_at_ms) / kDay_ms;
}

VisitSurface surfaceOf(const ReportedVisit& visit) {
  return {.foot = visit.model->foot,
          .outline = visit.model->outline,
          .landmarks = visit.model->landmarks,
          .left_out = {}};
}

/// The latest visit that has a model to lay another one on; null where none has.
const ReportedVisit* lastWithScan(std::span<const ReportedVisit> visits) {
  const auto found = std::ranges::find_if(visits.rbegin(), visits.rend(), &ReportedVisit::has_scan);
  return found == visits.rend() ? nullptr : &*found;
}

/// This visit against the last one before it that has a scan.
void addPrevious(std::span<const ReportedVisit> visits, ReportContent& content) {
  const ReportedVisit& now = visits.back();
  const ReportedVisit* const earlier = lastWithScan(visits.first(visits.size() - 1));
  if (!now.has_scan || earlier == nullptr) {
    content.why_no_comparison =
        "Without a usable scan of this visit and of an earlier one no surfaces can be compared.";
    return;
  }
  const ReportedVisit& before = *earlier;
  const double days = daysBetween(before, now);
  auto compared =
      compareVisits({surfaceOf(before), before.numbers}, {surfaceOf(now), now.numbers}, days);
  if (!compared) {
    content.why_no_comparison = compared.error().detail;
    return;
  }
  const auto wound = [](const ReportedVisit& visit) {
    return ComparedWound{.foot = visit.model->foot,
                         .wound = visit.model->wound,
                         .landmarks = visit.model->landmarks};
  };
  ReportComparison shown = illustrateComparison(wound(before), wound(now), std::move(*compared));
  shown.later_visit = static_cast<int>(visits.size());
  shown.earlier_visit = static_cast<int>(earlier - visits.data()) + 1;
  shown.earlier_date = isoTime(before.visit.content.taken_at_ms);
  shown.later_date = isoTime(now.visit.content.taken_at_ms);
  shown.days = days;
  content.comparison = std::move(shown);
}

/// Where the first visit's model lies in this one's frame; nothing where the skin does not say.
std::optional<RigidTransform> nowFromFirst(std::span<const ReportedVisit> visits,
                                           const ReportContent& content) {
  if (visits.size() == 2) {
    const bool accepted = content.comparison && content.comparison->result.registration.accepted;
    return accepted ? std::optional(content.comparison->result.registration.b_from_a)
                    : std::nullopt;
  }
  const auto laid = registerVisits(surfaceOf(visits.front()), surfaceOf(visits.back()));
  return laid && laid->accepted ? std::optional(laid->b_from_a) : std::nullopt;
}

void addFirstBed(std::span<const ReportedVisit> visits, ReportContent& content) {
  if (!content.section || !visits.front().has_scan || !visits.back().has_scan) {
    return;
  }
  const auto now_from_first = nowFromFirst(visits, content);
  if (!now_from_first) {
    return;
  }
  TriangleMesh moved{.vertices = visits.front().model->foot.mesh.vertices,
                     .faces = visits.front().model->foot.mesh.faces};
  for (Eigen::Vector3f& vertex : moved.vertices) {
    vertex = (*now_from_first * vertex.cast<double>()).cast<float>();
  }
  content.section->first_bed_mm = lineInSection(moved, *content.section);
}

}  // namespace

Expected<std::vector<ReportedVisit>> reportedVisits(const PatientHistory& history,
                                                    const Visit& visit) {
  std::map<std::string, const Measurement*> last;
  for (const Measurement& measurement : history.measurements) {
    last[measurement.visit_id] = &measurement;
  }
  if (visit.content.usable_scan && !last.contains(visit.id)) {
    return fail(ErrorCode::RecordMissing,
                "visit " + visit.id +
                    " was not measured; measure it, or mark it as without a usable scan and type "
                    "the ruler's values");
  }
  std::vector<ReportedVisit> reported;
  const auto add = [&](const Visit& each) {
    if (!each.content.usable_scan) {
      reported.push_back({each, nothingMeasured(kNoUsableScan), {}, {}, false});
    } else if (last.contains(each.id)) {
      const Measurement& measurement = *last.at(each.id);
      reported.push_back(
          {each, measurementFromJson(measurement.numbers), outlineOf(measurement.sketch), {}});
    }
  };
  const auto order = [](const Visit& each) { return std::tie(each.content.taken_at_ms, each.id); };
  for (const Visit& each : history.visits) {
    if (each.wound_id == visit.wound_id && order(each) < order(visit)) {
      add(each);
    }
  }
  add(visit);
  return reported;
}

Expected<void> openModel(Store& store, ReportedVisit& visit, const fs::path& folder) {
  return openTogether(store, std::array{&visit}, folder);
}

Expected<void> openModels(Store& store,
                          std::span<ReportedVisit> visits,
                          const fs::path& folder,
                          const Job& job) {
  std::vector<ReportedVisit*> shown;
  const ReportedVisit* const before = lastWithScan(visits.first(visits.size() - 1));
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    job.report("report", static_cast<double>(i) / static_cast<double>(visits.size() + 1));
    ReportedVisit& visit = visits[i];
    if (!visit.has_scan) {
      continue;
    }
    if (i == 0 || &visit == before || i + 1 == visits.size()) {
      shown.push_back(&visit);
    } else if (visit.outline_mm.size() < 3) {  // one after the other: only three stay in memory
      if (auto opened = openModel(store, visit, folder); !opened) {
        return opened;
      }
      visit.model.reset();
    }
  }
  return openTogether(store, shown, folder);
}

void addVisits(std::span<const ReportedVisit> visits, ReportContent& content) {
  for (const ReportedVisit& each : visits) {
    const json& fields = each.visit.content.fields;
    content.visits.push_back({.number = static_cast<int>(content.visits.size()) + 1,
                              .date = isoTime(each.visit.content.taken_at_ms),
                              .measurement = each.numbers,
                              .outline_mm = each.outline_mm,
                              .tissue = each.model ? each.model->tissue : std::nullopt,
                              .undermining_mm = deepestOf(fields, "undermining"),
                              .tunnel_mm = deepestOf(fields, "tunnels"),
                              .draft = each.visit.state == VisitState::Draft ||
                                       each.visit.state == VisitState::Returned});
  }
}

void addComparison(std::span<const ReportedVisit> visits, ReportContent& content) {
  if (visits.size() > 1) {
    addPrevious(visits, content);
    addFirstBed(visits, content);
  }
}

}  // namespace tarsus
