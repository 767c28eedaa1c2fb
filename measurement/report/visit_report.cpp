#include "measurement/report/visit_report.h"

#include "measurement/comparison/comparison.h"
#include "measurement/records/record_json.h"
#include "measurement/records/users.h"
#include "measurement/records/visit_measurement.h"
#include "measurement/report/change_picture.h"
#include "measurement/report/close_view.h"
#include "measurement/report/scan_quality.h"
#include "measurement/report/section_profile.h"
#include "measurement/report/visit_rows.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/sha256.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kDay_ms = 86'400'000.0;

/// A visit with its numbers and, once it was asked for, its model.
struct Measured {
  Visit visit;
  WoundMeasurement numbers;
  std::optional<MeasuredModel> model;
  std::vector<Eigen::Vector2d> outline_mm;  ///< where the model was let go
  std::optional<TissueShares> tissue;
};

/// The measured visits of one wound up to this one, which is the last.
Expected<std::vector<Measured>> measuredVisits(const PatientHistory& history, const Visit& visit) {
  std::map<std::string, const Measurement*> last;
  for (const Measurement& measurement : history.measurements) {
    last[measurement.visit_id] = &measurement;
  }
  std::vector<Measured> measured;
  for (const Visit& each : history.visits) {
    const bool counts = each.wound_id == visit.wound_id && each.id != visit.id &&
                        each.content.taken_at_ms < visit.content.taken_at_ms;
    if (counts && last.contains(each.id)) {
      measured.push_back({each, measurementFromJson(last.at(each.id)->numbers), {}, {}, {}});
    }
  }
  if (!last.contains(visit.id)) {
    return fail(ErrorCode::RecordMissing, "visit " + visit.id + " was not measured");
  }
  measured.push_back({visit, measurementFromJson(last.at(visit.id)->numbers), {}, {}, {}});
  return measured;
}

Expected<void> openModel(Store& store, Measured& measured, const fs::path& folder) {
  const auto files = visitFiles(store, measured.visit, folder / measured.visit.id);
  if (!files) {
    return tl::unexpected(files.error());
  }
  // The geometry alone: the numbers and their intervals are those that the visit keeps.
  auto model = measureFiles(*files, {.intervals = false});
  if (!model) {
    return tl::unexpected(model.error());
  }
  measured.model = std::move(*model);
  return {};
}

/// Keeps of a visit between the first and the one before what the trends show.
void keepOutline(Measured& measured) {
  const MeasuredModel& model = *measured.model;
  measured.outline_mm = outlineForTrends(illustrate(model.foot, model.wound, model.landmarks));
  measured.tissue = model.tissue;
  measured.model.reset();
}

NameOfUser namesOf(Store& store) {
  return [&store, names = std::map<std::string, std::string>()](const std::string& id) mutable {
    if (id.empty()) {
      return std::string();
    }
    if (!names.contains(id)) {
      const auto user = findUser(store, id);
      names[id] = user ? user->name : id;
    }
    return names[id];
  };
}

ReportState stateOf(VisitState state) {
  switch (state) {
    case VisitState::Signed:
    case VisitState::Amended:
      return ReportState::Signed;
    case VisitState::Reviewed:
      return ReportState::Reviewed;
    case VisitState::Draft:
    case VisitState::Returned:
      break;
  }
  return ReportState::Draft;
}

ReportRecord recordOf(const PatientHistory& history,
                      const Visit& visit,
                      const NameOfUser& name_of) {
  const PatientFields& patient = history.patient.fields;
  ReportRecord record;
  record.patient_name = patient.family_name +
                        (patient.family_name.empty() || patient.given_name.empty() ? "" : ", ") +
                        patient.given_name;
  record.birth_date = patient.birth_date;
  record.patient_id = patient.identifier.empty() ? history.patient.id : patient.identifier;
  for (const Wound& wound : history.wounds) {
    if (wound.id != visit.wound_id) {
      continue;
    }
    record.wound_number = wound.number;
    record.surface = wound.fields.aspect;
    record.site = wound.fields.place;
    record.aetiology = wound.fields.aetiology;
    record.onset = wound.fields.onset;
    for (const Foot& foot : history.feet) {
      if (foot.id == wound.foot_id) {
        record.side = foot.fields.side == FootSide::Left ? ReportSide::Left : ReportSide::Right;
      }
    }
  }
  record.visit_id = visit.id;
  record.visit_time = isoTime(visit.content.taken_at_ms);
  record.scanned_by = name_of(visit.signed_by.empty() ? visit.author : visit.signed_by);
  record.report_id = visit.id;
  record.version = static_cast<int>(visit.revision);
  record.state = stateOf(visit.state);
  return record;
}

/// Of what was signed: the visit and the measurement that counts.
std::string sha256Of(const Visit& visit, const WoundMeasurement& numbers) {
  const std::string text = toJson(visit).dump() + toJson(numbers).dump();
  Sha256 sum;
  sum.update(std::as_bytes(std::span(text)));
  return sum.hex();
}

MeasuredVisit comparedVisit(const Measured& visit) {
  return {.surface = {.foot = visit.model->foot,
                      .outline = visit.model->outline,
                      .landmarks = visit.model->landmarks,
                      .left_out = {}},
          .numbers = visit.numbers};
}

/// This visit against the one before it.
Expected<void> addComparison(std::span<Measured> visits, ReportContent& content) {
  const Measured& now = visits.back();
  const Measured& before = visits[visits.size() - 2];
  const double days =
      static_cast<double>(now.visit.content.taken_at_ms - before.visit.content.taken_at_ms) /
      kDay_ms;
  auto compared = compareVisits(comparedVisit(before), comparedVisit(now), days);
  if (!compared) {
    content.why_no_comparison = compared.error().detail;
    return {};
  }
  const auto wound = [](const Measured& m) {
    return ComparedWound{
        .foot = m.model->foot, .wound = m.model->wound, .landmarks = m.model->landmarks};
  };
  ReportComparison shown = illustrateComparison(wound(before), wound(now), std::move(*compared));
  shown.later_visit = static_cast<int>(visits.size());
  shown.earlier_visit = shown.later_visit - 1;
  shown.earlier_date = isoTime(before.visit.content.taken_at_ms);
  shown.later_date = isoTime(now.visit.content.taken_at_ms);
  shown.days = days;
  content.comparison = std::move(shown);
  return {};
}

void addVisits(std::span<const Measured> visits, ReportContent& content) {
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const Measured& each = visits[i];
    ReportVisit shown{.number = static_cast<int>(i) + 1,
                      .date = isoTime(each.visit.content.taken_at_ms),
                      .measurement = each.numbers,
                      .outline_mm = {},
                      .tissue = std::nullopt,
                      .undermining_mm = std::nullopt,
                      .tunnel_mm = std::nullopt};
    shown.tissue = each.tissue;
    shown.outline_mm = each.outline_mm;
    if (each.model) {
      shown.tissue = each.model->tissue;
      shown.outline_mm = i + 1 == visits.size()
                             ? outlineForTrends(content)
                             : outlineForTrends(illustrate(
                                   each.model->foot, each.model->wound, each.model->landmarks));
    }
    content.visits.push_back(std::move(shown));
  }
}

/// The first visit's bed in this visit's section, once its skin lies on this visit's.
void addFirstBed(std::span<const Measured> visits, ReportContent& content) {
  if (visits.size() < 2 || !content.section) {
    return;
  }
  const MeasuredModel& first = *visits.front().model;
  RigidTransform now_from_first = RigidTransform::Identity();
  if (visits.size() == 2) {
    if (!content.comparison || !content.comparison->result.registration.accepted) {
      return;
    }
    now_from_first = content.comparison->result.registration.b_from_a;
  } else {
    const auto compared =
        compareVisits(comparedVisit(first), comparedVisit(*visits.back().model), 1.0);
    if (!compared || !compared->registration.accepted) {
      return;
    }
    now_from_first = compared->registration.b_from_a;
  }
  TriangleMesh moved{.vertices = first.foot.mesh.vertices, .faces = first.foot.mesh.faces};
  for (Eigen::Vector3f& vertex : moved.vertices) {
    vertex = (now_from_first * vertex.cast<double>()).cast<float>();
  }
  content.section->first_bed_mm = lineInSection(moved, *content.section);
}

bool sameDay(const Visit& a, const Visit& b) {
  return isoTime(a.content.taken_at_ms).substr(0, 10) ==
         isoTime(b.content.taken_at_ms).substr(0, 10);
}

/// The patient's other wounds that were measured on the same day, two of them with pictures.
Expected<void> addOtherWounds(Store& store,
                              const PatientHistory& history,
                              const Visit& visit,
                              const fs::path& folder,
                              ReportContent& content) {
  constexpr std::size_t kWithPictures = 2;
  std::map<std::string, const Measurement*> last;
  for (const Measurement& measurement : history.measurements) {
    last[measurement.visit_id] = &measurement;
  }
  for (const Visit& each : history.visits) {
    if (each.wound_id == visit.wound_id || !sameDay(each, visit) || !last.contains(each.id)) {
      continue;
    }
    const ReportRecord place = recordOf(history, each, [](const std::string& id) { return id; });
    OtherWound other;
    other.wound_number = place.wound_number;
    other.side = place.side;
    other.surface = place.surface;
    other.site = place.site;
    other.report_id = each.id;
    Measured measured{each, measurementFromJson(last.at(each.id)->numbers), {}, {}, {}};
    other.measurement = measured.numbers;
    if (content.other_wounds.size() < kWithPictures) {
      if (auto opened = openModel(store, measured, folder); !opened) {
        return tl::unexpected(opened.error());
      }
      const MeasuredModel& model = *measured.model;
      ReportContent shown = illustrate(model.foot, model.wound, model.landmarks);
      other.texture = std::move(shown.texture);
      other.depth_map = std::move(shown.depth_map);
      other.mm_per_px = shown.close_mm_per_px;
      other.outline_px = std::move(shown.outline_px);
      other.unseen_px = std::move(shown.unseen_px);
    }
    content.other_wounds.push_back(std::move(other));
  }
  return {};
}

json reconstructionOf(const fs::path& folder) {
  const auto text = readTextFile(folder / "reconstruction.json");
  return text ? json::parse(*text, nullptr, false) : json();
}

}  // namespace

Expected<ReportContent> visitReport(Store& store,
                                    std::string_view visit_id,
                                    const fs::path& folder,
                                    const VisitReportOptions& options,
                                    const Job& job) {
  const auto versions = visitVersions(store, visit_id);
  if (!versions) {
    return tl::unexpected(versions.error());
  }
  const Visit& visit = versions->back();
  const auto patient = patientOf(store, visit);
  if (!patient) {
    return tl::unexpected(patient.error());
  }
  const auto history = patientHistory(store, *patient);
  if (!history) {
    return tl::unexpected(history.error());
  }
  auto visits = measuredVisits(*history, visit);
  if (!visits) {
    return tl::unexpected(visits.error());
  }
  // All for their outlines; the first, the one before and this one are kept for pictures.
  const std::size_t count = visits->size();
  for (std::size_t i = 0; i < count; ++i) {
    if (job.stopped()) {
      return fail(ErrorCode::Cancelled);
    }
    job.report("report", static_cast<double>(i) / static_cast<double>(count + 1));
    Measured& each = (*visits)[i];
    if (auto opened = openModel(store, each, folder); !opened) {
      return tl::unexpected(opened.error());
    }
    if (i > 0 && i + 2 < count) {
      keepOutline(each);
    }
  }
  const Measured& now = visits->back();
  ReportContent content = illustrate(now.model->foot, now.model->wound, now.model->landmarks);
  const NameOfUser name_of = namesOf(store);
  content.measurement = now.numbers;
  content.fit_for_measurement = now.model->fit_for_measurement;
  content.version = options.version;
  content.model_sha256 = now.model->foot.sha256;
  content.created = isoTime(visit.at_ms);
  content.language = options.language;
  content.form = options.form;
  content.paper = options.paper;
  content.record = recordOf(*history, visit, name_of);
  content.title_line = content.record->patient_name;
  const json reconstruction = reconstructionOf(folder / visit.id);
  addScanQuality(reconstruction, content);
  content.record->invented =
      reconstruction.is_object() &&
      reconstruction.value("camera", json::object()).value("model", "") == "Tarsus simulator";
  addVisits(*visits, content);
  if (count > 1) {
    if (auto compared = addComparison(*visits, content); !compared) {
      return tl::unexpected(compared.error());
    }
    addFirstBed(*visits, content);
  }
  if (auto added = addOtherWounds(store, *history, visit, folder, content); !added) {
    return tl::unexpected(added.error());
  }
  if (auto found = addFindings(visit, name_of, content); !found) {
    return tl::unexpected(found.error());
  }
  addHistory(*versions, name_of, content);
  std::vector<Visit> forms;
  for (const Measured& each : *visits) {
    forms.push_back(each.visit);
  }
  addEvents(forms, content);
  if (content.record->state != ReportState::Draft) {
    content.record_sha256 = sha256Of(visit, now.numbers);
  }
  return content;
}

}  // namespace tarsus
